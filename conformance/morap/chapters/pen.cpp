// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr BusAddress kPen{0x19};
constexpr int kDeployed = 8;
constexpr int kRetracted = 45;
/// The pen's handler takes 10 ms for a command, and 10 ms more for a value.
constexpr Duration kCommandTime = 25ms;
/// Buttons are looked at every 50 ms.
constexpr Duration kButtonTime = 60ms;

/// It was just switched on, and answers to its address.
void switch_on(NodeBench& node) {
  node.touch("pen-power", 1);
  node.touch("deploy", 0);
  node.touch("retract", 0);
}

void tell(NodeBench& node, std::string_view command) {
  const auto bytes = from_hex(command);
  node.about(fmt::format("the pen after {}", command));
  const auto written = node.write(kPen, *bytes);
  node.expect_true(written.is_whole(), "all of it to be acknowledged", "it was not");
  node.pause(kCommandTime);
}

void expect_seen(NodeBench& node, std::string_view what, std::int64_t wanted) {
  const auto seen = node.observe(what);
  node.expect_true(seen == wanted, fmt::format("{} {}", what, wanted), fmt::format("{}", seen));
}

void expect_servo(NodeBench& node, std::int64_t degrees) { expect_seen(node, "servo", degrees); }

/// A command after each of the two places, so that one which does nothing shows.
void expect_leads_to(NodeBench& node, std::string_view command, int degrees) {
  for (const auto* const before : {"01", "02"}) {
    tell(node, before);
    tell(node, command);
    expect_servo(node, degrees);
  }
}

constexpr Case with_pen(std::string_view rule, CaseBody run) {
  return from(kListening, Hazard::kMove, rule, run);
}

constexpr Clause kPenClauses[] = {
    must("morap.pen.address", "The pen acknowledges address 19.",
         "reference, pen; recording bus-nodes-and-pen"),
    with_pen("A write of nothing; nobody answers on both sides of it.",
             [](NodeBench& node) {
               switch_on(node);
               node.expect_true(node.write(kPen, {}).is_addressed, "an acknowledgement", "none");
               for (const BusAddress address : {BusAddress{0x18}, BusAddress{0x1A}}) {
                 if (node.address() != address) node.expect_absent(address);
               }
             }),
    variant("commands", with_pen("It acknowledges the bytes of 2, and of 7 with a byte.",
                                 [](NodeBench& node) {
                                   if (!node.write(kPen, {}).is_addressed) {
                                     return node.skip("needs a pen; none answers on this bus");
                                   }
                                   tell(node, "02");
                                   tell(node, "07 00");
                                 })),
    variant("hung", with_pen("It does so also when a surplus byte has hung it.",
                             [](NodeBench& node) {
                               if (!node.write(kPen, {}).is_addressed) {
                                 return node.skip("needs a pen; none answers on this bus");
                               }
                               node.touch("power", 1);  // it shows whether there is a hand
                               tell(node, "02 00");
                               tell(node, "02");
                               node.touch("power", 1);
                             })),

    must("morap.pen.at-boot", "At power-on the pen is retracted, at 45 degrees.", "vector P1"),
    with_pen("It is looked at, also after a command and power.",
             [](NodeBench& node) {
               switch_on(node);
               expect_servo(node, kRetracted);
               tell(node, "01");
               switch_on(node);
               node.about("the pen, switched on again");
               expect_servo(node, kRetracted);
               expect_seen(node, "lamp1", 0);
             }),

    must("morap.pen.deploy", "Command 1 deploys the pen, to 8 degrees.", "vector P2"),
    with_pen("From both places.",
             [](NodeBench& node) {
               switch_on(node);
               expect_leads_to(node, "01", kDeployed);
             }),

    must("morap.pen.retract", "Command 2 retracts the pen, to 45 degrees.", "vector P3"),
    with_pen("From both places.",
             [](NodeBench& node) {
               switch_on(node);
               expect_leads_to(node, "02", kRetracted);
             }),

    must("morap.pen.position",
         "Command 7 with a byte sets an angle between, 45 for 0 and 8 for 255, cut towards 45.",
         "vector P4; recording pen-set-position"),
    with_pen("Ten bytes.",
             [](NodeBench& node) {
               switch_on(node);
               struct Row {
                 const char* command;
                 int degrees;
               };
               for (const auto& [command, degrees] : {Row{"07 00", 45},
                                                      {"07 06", 45},
                                                      {"07 07", 44},
                                                      {"07 40", 36},
                                                      {"07 7F", 27},
                                                      {"07 80", 27},
                                                      {"07 83", 26},
                                                      {"07 FE", 9},
                                                      {"07 FF", 8},
                                                      {"07 01", 45}}) {
                 expect_leads_to(node, command, degrees);
               }
             }),

    must("morap.pen.position-missing", "Command 7 without a byte retracts the pen.", "vector P5"),
    with_pen("From both places.",
             [](NodeBench& node) {
               switch_on(node);
               expect_leads_to(node, "07", kRetracted);
             }),

    must("morap.pen.unknown", "Any other command retracts the pen.", "vector P6"),
    with_pen("Eight others.",
             [](NodeBench& node) {
               switch_on(node);
               for (const auto* const command : {"00", "03", "05", "06", "08", "09", "81", "FF"}) {
                 expect_leads_to(node, command, kRetracted);
               }
             }),

    must("morap.pen.poke", "A write of nothing leaves the pen where it is.", "vector P7"),
    with_pen("At both places.",
             [](NodeBench& node) {
               switch_on(node);
               for (const auto& [command, degrees] :
                    {std::pair{"01", kDeployed}, std::pair{"02", kRetracted}}) {
                 tell(node, command);
                 const auto lamp = node.observe("lamp1");
                 tell(node, "");
                 expect_servo(node, degrees);
                 expect_seen(node, "lamp1", lamp);
               }
             }),

    must("morap.pen.lamps",
         "One lamp turns over with each command, the other is lit while the pen is nearer to 8 "
         "degrees than to 45.",
         "reference, pen; recordings pen-set-position and pen-unknown-command"),
    with_pen("Six commands.",
             [](NodeBench& node) {
               switch_on(node);
               std::int64_t lamp1 = 0;
               struct Row {
                 const char* command;
                 int lamp2;
               };
               for (const auto& [command, lamp2] : {Row{"01", 1},
                                                    {"02", 0},
                                                    {"07 83", 1},  // 26 degrees
                                                    {"07 80", 0},  // 27 degrees
                                                    {"01", 1},
                                                    {"09", 0}}) {
                 tell(node, command);
                 lamp1 = 1 - lamp1;
                 expect_seen(node, "lamp1", lamp1);
                 expect_seen(node, "lamp2", lamp2);
               }
             }),

    must("morap.pen.surplus",
         "After a byte that a command does not need the pen does that command, and reacts to "
         "nothing more until its power was off.",
         "vector P8", Profiles::kFirmware),
    with_pen("1 and 7 with a byte more.",
             [](NodeBench& node) {
               for (const auto* const command : {"01 00", "07 FF 00"}) {
                 switch_on(node);
                 tell(node, command);
                 expect_servo(node, kDeployed);
                 const auto lamp = node.observe("lamp1");
                 tell(node, "02");
                 node.touch("retract", 1);
                 node.pause(kButtonTime);
                 expect_servo(node, kDeployed);
                 expect_seen(node, "lamp1", lamp);
               }
               switch_on(node);
               node.about("the pen, switched on again");
               expect_servo(node, kRetracted);
               tell(node, "01");
               expect_servo(node, kDeployed);
             }),

    must("morap.pen.buttons",
         "While a button is held it wins over the bus; they are looked at every 50 ms.",
         "recording pen-buttons"),
    variant("win", with_pen("Each button, both, and commands meanwhile.",
                            [](NodeBench& node) {
                              struct Row {
                                int deploy;
                                int retract;
                                const char* command;
                                int degrees;
                              };
                              switch_on(node);
                              for (const auto& [deploy, retract, command, degrees] :
                                   {Row{1, 0, "02", kDeployed},
                                    {0, 1, "01", kRetracted},
                                    {1, 1, "02", kDeployed},
                                    {0, 0, "02", kRetracted},
                                    {0, 0, "01", kDeployed},
                                    {0, 1, "", kRetracted},
                                    {0, 0, "", kRetracted},
                                    {1, 0, "", kDeployed},
                                    {0, 0, "", kDeployed}}) {
                                node.touch("deploy", deploy);
                                node.touch("retract", retract);
                                node.pause(kButtonTime);
                                tell(node, command);
                                node.pause(kButtonTime);
                                expect_servo(node, degrees);
                              }
                            })),
    variant("rhythm", with_pen("Pressed 10 ms after a look, it waits for the next.",
                               [](NodeBench& node) {
                                 switch_on(node);
                                 for (const auto& [button, before, after] :
                                      {std::tuple{"deploy", kRetracted, kDeployed},
                                       std::tuple{"retract", kDeployed, kRetracted}}) {
                                   node.pause(10ms);
                                   node.about(button);
                                   node.touch(button, 1);
                                   node.pause(38ms);
                                   expect_servo(node, before);
                                   node.pause(2ms);
                                   node.touch(button, 0);
                                   expect_servo(node, after);
                                 }
                               })),
};

}  // namespace

Chapter pen_chapter() { return chapter("Pen", kPenClauses); }

}  // namespace armjig::morap::conformance
