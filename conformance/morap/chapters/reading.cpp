// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

template <CommandId selector>
void zero_at_boot(NodeBench& node) {
  node.expect_bytes(selector, "00 00 00 00");
}

/// The bytes of an angle that is not 0.
auto turned_angle(NodeBench& node) {
  node.turn(1000);
  node.send(kReadAngle);
  return node.read_on(4);
}

constexpr Clause kReadingClauses[] = {
    must("morap.read.first-mode", "Before anything was chosen, a read answers with the angle.",
         "firmware, vector 1; the document is silent", Profiles::kFirmware),
    from(kFresh, Hazard::kState, "A turned shaft is read without a choice and with one.",
         [](NodeBench& node) {
           node.turn(1000);
           const auto unchosen = node.read_on(4);
           node.expect_same(unchosen, node.read(kReadAngle, 4));
         }),

    must("morap.read.angle-at-boot", "At power-on the angle is 0.", "firmware, vector 1"),
    from(kSwitchedOn, Hazard::kState, "It is read first.", on<zero_at_boot<kReadAngle>>),

    must("morap.read.voltage-at-boot", "At power-on the applied voltage is 0.",
         "firmware, vector 6"),
    from(kSwitchedOn, Hazard::kState, "It is read first.", on<zero_at_boot<kReadVoltage>>),

    must("morap.read.position-at-boot", "At power-on the position reference is 0.",
         "firmware, vector 6"),
    from(kSwitchedOn, Hazard::kState, "It is read first.",
         on<zero_at_boot<kReadPositionReference>>),

    must("morap.read.speed-at-boot", "At power-on the speed reference is 0.", "firmware, vector 6"),
    from(kSwitchedOn, Hazard::kState, "It is read first.", on<zero_at_boot<kReadSpeedReference>>),

    must("morap.read.address", "Identifier 136 chooses the node's own seven-bit address.",
         "document; vectors 4 and 5"),
    look("It is read.",
         [](NodeBench& node) {
           node.expect_same(node.read(kReadAddress, 1),
                            std::vector{std::byte{node.address().value}});
         }),

    must("morap.read.keeps-mode", "What was chosen stays chosen over any number of reads.",
         "recording static-readmode-latch"),
    from(kUncalibrated, Hazard::kState, "One choice, four reads.",
         [](NodeBench& node) {
           node.send(kSpeed, 0.75F);
           node.send(kReadSpeedReference);
           for (int i = 0; i < 4; ++i) node.expect_read_on("00 00 40 3F");
         }),

    must("morap.read.fresh",
         "What is read is what is so by then, whatever it was when it was chosen or last read.",
         "firmware, reading; recording static-readmode-latch"),
    variant("reference", from(kUncalibrated, Hazard::kState,
                              "One choice, and another speed reference before each read.",
                              [](NodeBench& node) {
                                node.send(kReadSpeedReference);
                                for (const auto* const bits :
                                     {"00 00 40 3F", "CD CC 4C 3E", "B8 1E 05 BF"}) {
                                  node.send_bytes(std::string{"02 "} + bits);
                                  node.expect_read_on(bits);
                                }
                              })),
    variant("status", from(kUncalibrated, Hazard::kState,
                           "One choice, and commands that change the motor status.",
                           [](NodeBench& node) {
                             node.send(kReadMotorStatus);
                             node.expect_read_on("03");
                             node.send(kCalibrateZero);
                             node.expect_read_on("02");
                             node.send(kVoltage, 0.0F);
                             node.expect_read_on("01");
                             node.send(kCalibrationUnknown);
                             node.expect_read_on("03");
                           })),
    variant("other-reference", from(kUncalibrated, Hazard::kState,
                                    "The position reference is chosen, then others are set.",
                                    [](NodeBench& node) {
                                      node.send(kPosition, 0.5F);
                                      node.send(kReadPositionReference);
                                      node.send(kSpeed, 0.25F);
                                      node.expect_read_on("00 00 00 3F");
                                      node.send(kPosition, 0.75F);
                                      node.send(kVoltage, 0.0F);
                                      node.expect_read_on("00 00 40 3F");
                                    })),
    variant("angle",
            from(kFresh, Hazard::kState, "One choice, then commands and turns of the shaft.",
                 [](NodeBench& node) {
                   const auto turned = turned_angle(node);
                   node.send(kCalibrateZero);
                   node.expect_read_on("00 00 00 00");
                   node.turn(1000);
                   node.send(kDisable);
                   node.expect_same(node.read_on(4), turned);
                 })),

    must("morap.read.mode-over-commands", "Commands do not change what is chosen.",
         "recording static-readmode-latch"),
    from(kUncalibrated, Hazard::kState, "The status is chosen, then commands of all sorts.",
         [](NodeBench& node) {
           node.send(kReadMotorStatus);
           node.send(kPosition, 0.5F);
           node.send(kSpeed, 0.5F);
           node.send(kDisable);
           node.send(kCalibrationUnknown);
           node.expect_read_on("03");
         }),
    variant("parameters",
            from(kProgrammable, Hazard::kProgram,
                 "The status is chosen, then a refused message, a tuning and the stored ones.",
                 [](NodeBench& node) {
                   node.send(kReadMotorStatus);
                   for (const auto* const message :
                        {"20 00 C8 00 05", "20 00 C8 00", "22 00 CD CC 4C 3E 00 00 10 C1", "21"}) {
                     node.about(fmt::format("after {}", message));
                     node.send_bytes(message);
                     node.expect_read_on("02");
                   }
                   node.about("after a message that is taken, when it is in use");
                   node.send(proportional(kIdleRateHz, 1.0F));
                   node.settle();
                   node.expect_read_on("02");
                 })),

    must("morap.read.mode-over-brake", "The brake commands do not change what is chosen.",
         "firmware"),
    from(kUncalibrated, Hazard::kState, "The status is chosen, then 14 and 15.",
         [](NodeBench& node) {
           node.send(kReadMotorStatus);
           node.send(kBrake14);
           node.send(kBrake15);
           node.expect_read_on("03");
         }),

    must("morap.read.mode-over-unknown", "Unknown identifiers do not change what is chosen.",
         "firmware, vector 23"),
    from(kUncalibrated, Hazard::kState, "The status is chosen, then identifiers without a meaning.",
         [](NodeBench& node) {
           node.send(kReadMotorStatus);
           for (const auto* const id : {"06", "23", "87", "8C", "FF"}) {
             node.about(fmt::format("after {}", id));
             node.send_bytes(id);
             node.expect_read_on("03");
           }
         }),

    must("morap.read.surplus", "A byte after a choice is no choice itself.", "firmware, vector 21"),
    from(kUncalibrated, Hazard::kState,
         "The speed reference is chosen, with another choice after it.",
         [](NodeBench& node) {
           node.send(kSpeed, 0.75F);
           node.send_bytes("82 81");
           node.expect_read_on("00 00 40 3F");
         }),

    must("morap.read.short",
         "Reading fewer bytes than there are does no harm: the next read begins again.",
         "firmware, reading"),
    from(kUncalibrated, Hazard::kState, "Two bytes, one byte, all four.",
         [](NodeBench& node) {
           node.send(kSpeed, 0.2F);
           node.send(kReadSpeedReference);
           node.expect_read_on("CD CC");
           node.expect_read_on("CD");
           node.expect_read_on("CD CC 4C 3E");
         }),

    must("morap.read.little-endian", "Numbers are sent least significant byte first.",
         "document; vectors 12 and 17"),
    from(kFresh, Hazard::kState, "A thousand counts, not calibrated.",
         [](NodeBench& node) { expect_turned(node); }),

    must("morap.read.snapshot", "The four bytes of a number are of one moment, that of the first.",
         "firmware, reading"),
    from(kFresh, Hazard::kState, "The shaft turns after the first byte.",
         [](NodeBench& node) {
           const auto before = turned_angle(node);
           node.expect_same(node.read_around(node.address(), 4, [&] { node.turn(5000); }), before);
         }),

    Requirement{"morap.read.wrap", Level::kMay,
                "Byte 256 of a read of a number begins it again, with a new value.",
                "firmware, vector 68", Profiles::kFirmware},
    from(kFresh, Hazard::kState, "260 bytes, and the shaft turns between.",
         [](NodeBench& node) {
           const auto first = turned_angle(node);
           const auto bytes = node.read_around(node.address(), 260, [&] { node.turn(1000); });
           node.about("the first four of 260 bytes");
           node.expect_same(Bytes{bytes}.first(std::min<std::size_t>(bytes.size(), 4)), first);
           const auto second = node.read_on(4);
           node.about("the last four, after a turn of the shaft");
           node.expect_same(Bytes{bytes}.subspan(bytes.size() < 260 ? 0 : 256), second);
         }),

    must("morap.read.byte-again",
         "A reading of one byte is repeated for as long as the master reads.",
         "firmware, vector 20", Profiles::kFirmware),
    from(kUncalibrated, Hazard::kState, "The status, four times in one read.",
         [](NodeBench& node) { node.expect_bytes(kReadMotorStatus, "03 03 03 03"); }),

    must("morap.read.set-filled", "After a controller set zeros are read.", "firmware, vector 26",
         Profiles::kFirmware),
    look("64 bytes are read.",
         [](NodeBench& node) {
           const auto bytes = node.read(kReadPositionSet, 64);
           const auto set = decode_set(bytes);
           const auto* good = std::get_if<ControllerSet>(&set);
           node.expect_true(good != nullptr, "a controller set", "none");
           const auto size = good == nullptr ? 0 : wire_size(*good);
           node.expect_same(Bytes{bytes}.subspan(size),
                            std::vector<std::byte>(bytes.size() - size));
         }),

    Requirement{"morap.read.set-wrap", Level::kMay,
                "Byte 256 of a read of a controller set is its first again.",
                "recording static-read-wrap", Profiles::kFirmware},
    look("287 bytes are read.",
         [](NodeBench& node) {
           const auto set = node.read(kReadPositionSet, 31);
           const auto bytes = node.read_on(256 + 31);
           node.expect_same(Bytes{bytes}.subspan(256), set);
         }),

    must("morap.read.set-checksum", "A controller set is read with the checksum of its bytes.",
         "firmware, read-back", Profiles::kFirmware),
    look("Both sets are read.",
         [](NodeBench& node) {
           for (const auto selector : {kReadPositionSet, kReadSpeedSet}) {
             const auto bytes = node.read(selector, kLargestSetSize);
             const auto set = decode_set(bytes);
             node.expect_true(std::holds_alternative<ControllerSet>(set), "a set with its checksum",
                              "another checksum");
           }
         }),

    must("morap.read.position-default",
         "The position controller is the one in the EEPROM until it is programmed.",
         "vectors 26 and 28", Profiles::kFirmware),
    from(kProgrammable, Hazard::kProgram, "It is loaded and read.",
         [](NodeBench& node) { node.expect_bytes(kReadPositionSet, node.motor().position_set); }),

    must("morap.read.speed-default",
         "The speed controller is the one in the EEPROM until it is programmed.",
         "vectors 27 and 29", Profiles::kFirmware),
    from(kProgrammable, Hazard::kProgram, "It is loaded and read.",
         [](NodeBench& node) { node.expect_bytes(kReadSpeedSet, node.motor().speed_set); }),
};

}  // namespace

Chapter reading_chapter() { return chapter("Reading", kReadingClauses); }

}  // namespace armjig::morap::conformance
