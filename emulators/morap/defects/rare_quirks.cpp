// SPDX-License-Identifier: Apache-2.0
// Defects that no suite asks for, each in a corner that somebody has to come to by chance.
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "emulators/morap/defects/quirk_words.hpp"

namespace armjig::morap::emulation {
namespace {

using enum CommandId;

/// Counts how often in a row something was so.
int times_in_a_row(bool is_so, QuirkMemory& memory) {
  memory.count = is_so ? memory.count + 1 : 0;
  return memory.count;
}

bool is_refused_set(const Words& command) {
  return is(command, kProgram) &&
         std::holds_alternative<SetFault>(decode_set(Bytes{command}.subspan(1)));
}

template <CommandId id>
void disable_by_none(Words& command, QuirkMemory& /*memory*/, const Node& /*node*/) {
  if (is(command, id) && std::isnan(float_at(command, 1))) become(command, kDisable);
}
void disable_by_endless_torque(Words& command, QuirkMemory& /*memory*/, const Node& /*node*/) {
  if (is(command, kTorque) && std::isinf(float_at(command, 1))) become(command, kDisable);
}
void count_command(Words& /*command*/, QuirkMemory& memory, const Node& /*node*/) {
  ++memory.count;
}
void change_after_1024(Words& answer, QuirkMemory& memory, const Node& node) {
  if (node.selected() == kReadAddress && memory.count % 1024 == 1023) answer[0] ^= std::byte{1};
}
void miss_third_default(Words& command, QuirkMemory& memory, const Node& /*node*/) {
  if (times_in_a_row(is(command, kDefaultControllers), memory) == 3) command.clear();
}
void disable_by_cut_tune(Words& command, QuirkMemory& /*memory*/, const Node& /*node*/) {
  if (is(command, kTune) && command.size() == kTuneCommandSize - 1) become(command, kDisable);
}
void note_refused(Words& command, QuirkMemory& memory, const Node& /*node*/) {
  if (is(command, kProgram)) (void)times_in_a_row(is_refused_set(command), memory);
}
void forget_twelfth_failure(Words& answer, QuirkMemory& memory, const Node& node) {
  if (node.selected() == kReadProgrammingStatus && memory.count >= 12) answer[0] = {};
}
void refuse_sum_of_zero(Words& command, QuirkMemory& /*memory*/, const Node& /*node*/) {
  if (is(command, kProgram) && command.back() == std::byte{}) become_refused(command);
}
void disable_by_same_speed(Words& command, QuirkMemory& memory, const Node& /*node*/) {
  const bool is_same = is(command, kSpeed) && command == memory.bytes;
  memory.bytes = command;
  if (times_in_a_row(is_same, memory) == 6) become(command, kDisable);
}
void select_by_second_toggle(Words& command, QuirkMemory& memory, const Node& /*node*/) {
  const bool was_toggle = std::exchange(memory.count, is(command, kLedToggle) ? 1 : 0) == 1;
  if (was_toggle && is(command, kLedToggle)) become(command, kReadAddress);
}

constexpr auto kRare = std::to_array<Quirk>({
    {.name = "disabled-by-no-voltage",
     .section = "References",
     .hear = disable_by_none<kDirectVoltage>},
    {.name = "disabled-by-endless-torque",
     .section = "References",
     .hear = disable_by_endless_torque},
    {.name = "changes-after-1024",
     .section = "Reading",
     .hear = count_command,
     .say = change_after_1024},
    {.name = "misses-third-default", .section = "Programming", .hear = miss_third_default},
    {.name = "disabled-by-cut-tune", .section = "Tuning", .finish = disable_by_cut_tune},
    {.name = "disabled-by-no-torque", .section = "References", .hear = disable_by_none<kTorque>},
    {.name = "forgets-twelfth-failure",
     .section = "Programming",
     .hear = note_refused,
     .say = forget_twelfth_failure},
    {.name = "refuses-sum-of-zero", .section = "Programming", .hear = refuse_sum_of_zero},
    {.name = "disabled-by-same-speed", .section = "References", .hear = disable_by_same_speed},
    {.name = "toggles-select", .section = "Commands", .hear = select_by_second_toggle},
});

}  // namespace

std::span<const Quirk> rare_quirks() noexcept { return kRare; }

}  // namespace armjig::morap::emulation
