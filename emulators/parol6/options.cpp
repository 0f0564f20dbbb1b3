// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/options.hpp"

#include <array>
#include <utility>
#include <vector>

#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::emulation {
namespace {

struct Settings {
  ArmOptions arm;
  Defects defects;
  std::vector<Fault> sent;
};

/// So many steps on its open side.
void stand_before_switch(Axis& axis, Steps steps) {
  const auto is_above = axis.limit.side == LimitSwitch::Side::kAtOrBelow;
  axis.position = is_above ? axis.limit.threshold + steps : axis.limit.threshold - steps;
}

// Later rows change what earlier ones have set.
constexpr auto kTable = std::to_array<DeviceOption<Settings>>({
    {{"profile", "firmware|documented",
      "the shipped board (the default), or the one that the document promises"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.arm.profile, {kFirmwareBoard, kDocumentedBoard});
     }},
    {{"crc", "ignore|d4|d4-or-e4",
      "which check bytes it takes; firmware ignores them, documented wants d4"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.arm.profile.check, {CheckPolicy::kIgnore, CheckPolicy::kBoardOnly,
                                                  CheckPolicy::kBoardOrHost});
     }},
    {{"estop", "report|disable",
      "what a pressed emergency stop does; documented is disabled by it"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.arm.profile.disables_at_estop, {false, true});
     }},
    {{"bounds", "none|stop",
      "whether jog and go-to stop a homed joint at its bound; neither profile does"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.arm.profile.stops_at_bounds, {false, true});
     }},
    {{"pass-us", "1..1000", "length of a pass of the main loop in microseconds; 10 if not given"},
     [](Settings& to, const OptionValue& value) { return value.take(to.arm.timing.pass_period); }},
    {{"to-switch", "0..100000,...",
      "how many steps each joint stands before its limit switch, 1 to 6; as after a run to "
      "standby, "
      "joint 6 beside it, if not given"},
     [](Settings& to, const OptionValue& value) {
       std::size_t joint = 0;
       return value.each([&](const OptionValue& one) -> Outcome<void> {
         std::int32_t steps{};
         if (auto taken = one.take(steps); !taken) return taken;
         if (joint == kJointCount) {
           return one.take(problem(ErrorCode::kBadValue, "", "there are six joints"));
         }
         stand_before_switch(to.arm.plant.axes[joint++], Steps{steps});
         return {};
       });
     }},
    {{"fault", "FAULT,...",
      "defects, as `armjig conformance mutants parol6 --list` names them: KIND:FIELD changes "
      "what the board sends"},
     [](Settings& to, const OptionValue& value) {
       return value.take_each(
           [&](std::string_view text) { return add_fault(text, to.arm, to.defects, to.sent); });
     }},
});
constexpr auto kRows = rows_of(kTable);

}  // namespace

std::span<const OptionRow> options() noexcept { return kRows; }

Outcome<Faulty<DefectiveArm>> make(const DeviceOptions& options, const std::string& where) {
  return read_options("parol6", kTable, options, where, Settings{}).map([](Settings settings) {
    return Faulty{DefectiveArm{settings.arm, std::move(settings.defects)}, std::move(settings.sent),
                  kCommandFrameSize};
  });
}

}  // namespace armjig::parol6::emulation
