// SPDX-License-Identifier: Apache-2.0
// Defects that no suite asks for, each in a corner that somebody has to come to by chance.
#include <array>
#include <chrono>

#include "emulators/parol6/defects/quirks.hpp"

namespace armjig::parol6::emulation {
namespace {

using namespace std::chrono_literals;

bool is_unknown(Command code) noexcept {
  return code != Command::kDemo && code != Command::kHome && code != Command::kEnable &&
         code != Command::kDisable && code != Command::kClearError && code != Command::kJog &&
         code != Command::kGoTo && code != Command::kIdle;
}

/// Counts how often in a row something was so.
std::int32_t times_so(bool is_so, QuirkMemory& memory) noexcept {
  memory.numbers[0] = is_so ? memory.numbers[0] + 1 : 0;
  return memory.numbers[0];
}

void change_after_1024(TelemetryFrame& answer, const CommandFrame& /*asked*/, QuirkMemory& memory,
                       const Board& /*board*/) {
  if (++memory.numbers[0] == 1024) answer.gripper.id ^= 1U;
}
void number_echo(TelemetryFrame& answer, const CommandFrame& asked, QuirkMemory& memory,
                 const Board& /*board*/) {
  const bool is_same = is_unknown(asked.command) && asked.command == memory.before.asked.command;
  if (times_so(is_same, memory) == 4) answer.echo = {};
}
void lose_borrow(TelemetryFrame& answer, const CommandFrame& /*asked*/, QuirkMemory& /*memory*/,
                 const Board& /*board*/) {
  auto& position = answer.position[4];
  if (position.value < 0 && (position.value & 0x3FF) == 0x180) position = position + Steps{0x400};
}
void leave_speed(TelemetryFrame& answer, const CommandFrame& asked, QuirkMemory& memory,
                 const Board& /*board*/) {
  const auto before = memory.before.asked.command;
  if (before == Command::kHome && asked.command == Command::kGoTo) memory.is_set = true;
  if (asked.command == Command::kEnable) memory.is_set = false;
  if (memory.is_set) answer.speed[5] = answer.speed[5] + StepsPerSecond{1};
}
void drop_outputs(CommandFrame& frame, QuirkMemory& memory, const Board& /*board*/) {
  if (times_so(frame.command == Command::kEnable, memory) == 8) frame.in_out = 0;
}
void miss_last_goal(CommandFrame& frame, QuirkMemory& /*memory*/, const Board& /*board*/) {
  constexpr std::int32_t kLast = 0x7F'FFFF;
  if (frame.command == Command::kGoTo && frame.position[5].value == kLast) frame.position[5] = {};
}
void disable_by_timeout(CommandFrame& frame, QuirkMemory& /*memory*/, const Board& /*board*/) {
  if (frame.timeout == 0x55) frame.command = Command::kDisable;
}
void time_long_gap(TelemetryFrame& answer, const CommandFrame& /*asked*/, QuirkMemory& memory,
                   const Board& /*board*/) {
  if (memory.gap > 5s) ++answer.timing;
}
void keep_echo_in_burst(TelemetryFrame& answer, const CommandFrame& asked, QuirkMemory& memory,
                        const Board& /*board*/) {
  const auto before = memory.before.asked.command;
  const bool is_jog_after_home = before == Command::kHome && asked.command == Command::kJog;
  if (memory.gap == 0s && is_jog_after_home) answer.echo = before;
}
void turn_smallest_speed(CommandFrame& frame, QuirkMemory& /*memory*/, const Board& /*board*/) {
  if (frame.command == Command::kJog && frame.speed[3].value == -1) frame.speed[3].value = 1;
}

constexpr std::array<Quirk, 10> kRare{{
    {"changes-after-1024", "Telemetry", nullptr, change_after_1024},
    {"loses-fifth-echo", "Telemetry", nullptr, number_echo},
    {"loses-borrow", "Telemetry", nullptr, lose_borrow},
    {"leaves-speed", "Telemetry", nullptr, leave_speed},
    {"drops-outputs", "Inputs and outputs", drop_outputs, nullptr},
    {"misses-last-goal", "Go-to law", miss_last_goal, nullptr},
    {"disabled-by-timeout", "Commands", disable_by_timeout, nullptr},
    {"times-long-gap", "Timing", nullptr, time_long_gap},
    {"keeps-echo-in-burst", "Telemetry", nullptr, keep_echo_in_burst},
    {"turns-smallest-speed", "Jog", turn_smallest_speed, nullptr},
}};

}  // namespace

std::span<const Quirk> rare_quirks() noexcept { return kRare; }

}  // namespace armjig::parol6::emulation
