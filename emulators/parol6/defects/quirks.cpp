// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/defects/quirks.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::emulation {
namespace {

constexpr std::uint8_t kJointFlags = 0xFC;
constexpr std::uint8_t kNoneHomed = 0x03;

template <class Change>
void each_speed(CommandFrame& frame, Command code, Change change) {
  if (frame.command != code) return;
  for (auto& speed : frame.speed) speed.value = change(speed.value);
}

bool is_motion(Command code) noexcept {
  return code == Command::kJog || code == Command::kGoTo || code == Command::kHome ||
         code == Command::kDemo || code == Command::kIdle;
}

std::uint8_t swapped_flags(std::uint8_t flags, std::uint8_t a, std::uint8_t b) noexcept {
  const bool has_a = (flags & a) != 0;
  const bool has_b = (flags & b) != 0;
  flags = static_cast<std::uint8_t>(flags & ~(a | b));
  return static_cast<std::uint8_t>(flags | (has_a ? b : 0) | (has_b ? a : 0));
}

// What the board hears.
using Hear = decltype(Quirk::hear);
constexpr Hear kJogClipped = [](CommandFrame& frame, QuirkMemory&, const Board&) {
  each_speed(frame, Command::kJog, [](int speed) { return std::clamp(speed, -1000, 1000); });
};
constexpr Hear kJogSlow = [](CommandFrame& frame, QuirkMemory&, const Board&) {
  each_speed(frame, Command::kJog, [](int speed) { return speed * 9 / 10; });
};
constexpr Hear kFeedIgnored = [](CommandFrame& frame, QuirkMemory&, const Board&) {
  each_speed(frame, Command::kGoTo, [](int) { return 0; });
};
constexpr Hear kFeedDoubled = [](CommandFrame& frame, QuirkMemory&, const Board&) {
  each_speed(frame, Command::kGoTo, [](int speed) { return 2 * speed; });
};
constexpr Hear kFeedNegated = [](CommandFrame& frame, QuirkMemory&, const Board&) {
  each_speed(frame, Command::kGoTo, [](int speed) { return -speed; });
};
constexpr Hear kGoalFar = [](CommandFrame& frame, QuirkMemory&, const Board& board) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    frame.position[j] = frame.position[j] + frame.position[j] - board.joints()[j].position();
  }
};
constexpr Hear kGoalRelative = [](CommandFrame& frame, QuirkMemory&, const Board& board) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    frame.position[j] = frame.position[j] + board.joints()[j].position();
  }
};
constexpr Hear kGoalOfSixteenBits = [](CommandFrame& frame, QuirkMemory&, const Board&) {
  for (auto& goal : frame.position) goal = Steps{static_cast<std::int16_t>(goal.value)};
};
constexpr Hear kJ6DragsJ4 = [](CommandFrame& frame, QuirkMemory&, const Board&) {
  frame.speed[3] = frame.speed[3] + StepsPerSecond{frame.speed[5].value / 2};
};
constexpr Hear kOneJointAtATime = [](CommandFrame& frame, QuirkMemory&, const Board&) {
  bool has_one = false;
  each_speed(frame, Command::kJog, [&has_one](int speed) {
    const bool is_further_one = std::exchange(has_one, has_one || speed != 0);
    return is_further_one ? 0 : speed;
  });
};
constexpr Hear kSpeedsKept = [](CommandFrame& frame, QuirkMemory& memory, const Board&) {
  if (memory.before.passed.command == Command::kJog && frame.command == Command::kJog) {
    frame.speed = memory.before.passed.speed;
  }
};
constexpr Hear kOutputsSwapped = [](CommandFrame& frame, QuirkMemory&, const Board&) {
  frame.in_out = swapped_flags(frame.in_out, io_flag::kOut1, io_flag::kOut2);
};
constexpr Hear kOutputsPulse = [](CommandFrame& frame, QuirkMemory& memory, const Board&) {
  if (frame.in_out == memory.before.asked.in_out) frame.in_out = 0;
};
constexpr Hear kOutputsOffWhenDisabled = [](CommandFrame& frame, QuirkMemory&, const Board& board) {
  if (!board.is_enabled() || frame.command == Command::kDisable) frame.in_out = 0;
};
constexpr Hear kGripperIdMasked = [](CommandFrame& frame, QuirkMemory&, const Board&) {
  frame.gripper.id &= 0x0F;
};
constexpr Hear kGripperWaits = [](CommandFrame& frame, QuirkMemory&, const Board& board) {
  if (!board.is_enabled()) frame.gripper = {};
};

// What it says.
using Say = decltype(Quirk::say);
constexpr Say kHomedEarly = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                               const Board& board) {
  if (board.is_homing()) answer.homed |= kJointFlags;
};
constexpr Say kHomedWithBase = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                                  const Board&) {
  if ((answer.homed & kJointFlags) != 0) answer.homed |= kJointFlags;
};
constexpr Say kHomedOnlyWhole = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                                   const Board&) {
  if (!is_homed(answer)) answer.homed = kNoneHomed;
};
constexpr Say kHomedStays = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory& memory,
                               const Board&) { answer.homed |= memory.before.said.homed; };
template <Command command>
constexpr Say kHomedLostBy =
    [](TelemetryFrame& answer, const CommandFrame& asked, QuirkMemory& memory, const Board& board) {
      if (asked.command == command) memory.is_set = true;
      if (board.is_homing()) memory.is_set = false;
      if (memory.is_set) answer.homed = kNoneHomed;
    };
constexpr Say kEstopInverted = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                                  const Board&) { answer.io ^= io_flag::kEstopReleased; };
constexpr Say kEstopLatched = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory& memory,
                                 const Board&) {
  memory.is_set = memory.is_set || is_estop_pressed(answer);
  if (memory.is_set) answer.io = static_cast<std::uint8_t>(answer.io & ~io_flag::kEstopReleased);
};
constexpr Say kInputsSwapped = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                                  const Board&) {
  answer.io = swapped_flags(answer.io, io_flag::kIn1, io_flag::kIn2);
};
constexpr Say kInputsLatched = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory& memory,
                                  const Board&) {
  answer.io |= memory.before.said.io & (io_flag::kIn1 | io_flag::kIn2);
};
constexpr Say kSpeedMeasured = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory& memory,
                                  const Board&) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (answer.position[j] == memory.before.truth.position[j]) answer.speed[j] = {};
  }
};
constexpr Say kSpeedGoneWhenStopped = [](TelemetryFrame& answer, const CommandFrame&,
                                         QuirkMemory& memory, const Board&) {
  if (!is_motion(memory.before.asked.command)) answer.speed = {};
};
constexpr Say kSpeedUnsigned = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                                  const Board&) {
  for (auto& speed : answer.speed) speed = StepsPerSecond{std::abs(speed.value)};
};
constexpr Say kSpeedFresh = [](TelemetryFrame& answer, const CommandFrame& asked, QuirkMemory&,
                               const Board&) {
  if (asked.command == Command::kJog) answer.speed = asked.speed;
};
template <Command code>
void reset_counters(TelemetryFrame& answer, const CommandFrame& asked, QuirkMemory& memory,
                    const Board& /*board*/) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (asked.command == code) memory.numbers[j] = answer.position[j].value;
    answer.position[j] = answer.position[j] - Steps{memory.numbers[j]};
  }
}
constexpr Say kCreeps = [](TelemetryFrame& answer, const CommandFrame& asked, QuirkMemory& memory,
                           const Board&) {
  if (asked.command == Command::kEnable) memory.is_set = true;
  if (!memory.is_set) ++memory.numbers[0];
  answer.position[0] = answer.position[0] + Steps{memory.numbers[0]};
};
constexpr Say kStepsLost = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                              const Board&) {
  for (auto& position : answer.position) position = position - Steps{position.value / 64};
};
constexpr Say kCoarse = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                           const Board&) {
  for (auto& position : answer.position) position = Steps{position.value & ~3};
};
constexpr Say kSixteenBits = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                                const Board&) {
  for (auto& position : answer.position) {
    position = Steps{static_cast<std::int16_t>(position.value)};
  }
};
constexpr Say kEchoOfKnown = [](TelemetryFrame& answer, const CommandFrame& asked, QuirkMemory&,
                                const Board&) {
  if (asked.command == Command{42} || asked.command == Command{200}) answer.echo = Command::kIdle;
};
constexpr Say kTimingSaturates = [](TelemetryFrame& answer, const CommandFrame&,
                                    QuirkMemory& memory, const Board&) {
  if (memory.gap > std::chrono::microseconds{93'206}) answer.timing = 0xFFFF;
};
constexpr Say kTimingFromStart = [](TelemetryFrame& answer, const CommandFrame&,
                                    QuirkMemory& memory, const Board&) {
  answer.timing = static_cast<std::uint16_t>(answer.timing + memory.before.said.timing);
};
constexpr Say kTimingSlow = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                               const Board&) {
  answer.timing = static_cast<std::uint16_t>(answer.timing * 19 / 20);
};
constexpr Say kGripperInverted = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                                    const Board&) {
  answer.gripper.position = static_cast<std::int16_t>(255 - answer.gripper.position);
};
constexpr Say kObjectBitsSwapped = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                                      const Board&) {
  answer.gripper.status =
      swapped_flags(answer.gripper.status, gripper_status::kObjectLow, gripper_status::kObjectHigh);
};
constexpr Say kCurrentUnsigned = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                                    const Board&) {
  answer.gripper.current =
      Milliamperes{static_cast<std::int16_t>(std::abs(answer.gripper.current.value))};
};
constexpr Say kGripperOldInMotion = [](TelemetryFrame& answer, const CommandFrame& asked,
                                       QuirkMemory& memory, const Board&) {
  if (asked.command == Command::kJog) answer.gripper = memory.before.said.gripper;
};
constexpr Say kCheckOfHosts = [](TelemetryFrame& answer, const CommandFrame&, QuirkMemory&,
                                 const Board&) { answer.check = kCheckHost; };

constexpr Quirk hears(std::string_view name, std::string_view section, Hear hear) noexcept {
  return {name, section, hear, nullptr};
}
constexpr Quirk says(std::string_view name, std::string_view section, Say say) noexcept {
  return {name, section, nullptr, say};
}

constexpr std::array kQuirks{
    hears("jog-clipped", "Jog", kJogClipped),
    hears("jog-slow", "Jog", kJogSlow),
    hears("one-joint-at-a-time", "Jog", kOneJointAtATime),
    hears("jog-keeps-speeds", "Jog", kSpeedsKept),
    hears("j6-drags-j4", "Jog", kJ6DragsJ4),
    hears("feed-ignored", "Go-to law", kFeedIgnored),
    hears("feed-doubled", "Go-to law", kFeedDoubled),
    hears("feed-negated", "Go-to law", kFeedNegated),
    hears("goal-twice-as-far", "Go-to law", kGoalFar),
    hears("goal-relative", "Go-to law", kGoalRelative),
    hears("goal-16-bit", "Go-to law", kGoalOfSixteenBits),
    hears("outputs-swapped", "Inputs and outputs", kOutputsSwapped),
    hears("outputs-pulse", "Inputs and outputs", kOutputsPulse),
    hears("outputs-off-when-disabled", "Inputs and outputs", kOutputsOffWhenDisabled),
    hears("gripper-id-masked", "Gripper", kGripperIdMasked),
    hears("gripper-waits-for-enable", "Gripper", kGripperWaits),
    says("homed-early", "Homing", kHomedEarly),
    says("homed-with-base", "Homing", kHomedWithBase),
    says("homed-only-whole", "Homing", kHomedOnlyWhole),
    says("homed-stays", "Homing", kHomedStays),
    says("homed-lost-by-jog", "Homing", kHomedLostBy<Command::kJog>),
    says("homed-lost-by-disable", "Homing", kHomedLostBy<Command::kDisable>),
    says("estop-inverted", "Inputs and outputs", kEstopInverted),
    says("estop-latched", "Inputs and outputs", kEstopLatched),
    says("inputs-swapped", "Inputs and outputs", kInputsSwapped),
    says("inputs-latched", "Inputs and outputs", kInputsLatched),
    says("speed-measured", "Telemetry", kSpeedMeasured),
    says("speed-gone-when-stopped", "Telemetry", kSpeedGoneWhenStopped),
    says("speed-unsigned", "Telemetry", kSpeedUnsigned),
    says("speed-fresh", "Telemetry", kSpeedFresh),
    says("counters-reset-by-enable", "Commands", reset_counters<Command::kEnable>),
    says("counters-reset-by-disable", "Commands", reset_counters<Command::kDisable>),
    says("counters-reset-by-clear", "Commands", reset_counters<Command::kClearError>),
    says("creeps-from-power-up", "Commands", kCreeps),
    says("steps-lost", "Telemetry", kStepsLost),
    says("positions-coarse", "Telemetry", kCoarse),
    says("positions-16-bit", "Telemetry", kSixteenBits),
    says("echo-of-known-codes", "Telemetry", kEchoOfKnown),
    says("timing-saturates", "Timing", kTimingSaturates),
    says("timing-adds-up", "Timing", kTimingFromStart),
    says("timing-slow", "Timing", kTimingSlow),
    says("gripper-inverted", "Gripper", kGripperInverted),
    says("object-bits-swapped", "Gripper", kObjectBitsSwapped),
    says("gripper-current-unsigned", "Gripper", kCurrentUnsigned),
    says("gripper-old-in-motion", "Gripper", kGripperOldInMotion),
    says("check-of-hosts", "Telemetry", kCheckOfHosts),
};

}  // namespace

std::span<const Quirk> quirks() noexcept { return kQuirks; }

}  // namespace armjig::parol6::emulation
