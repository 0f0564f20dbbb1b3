// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/mutants.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "emulators/parol6/defects/defects.hpp"

namespace armjig::parol6 {
namespace {

/// Why nobody can tell a mutant from a sound board.
struct Equivalent {
  std::string_view name;
  std::string_view reason;
};
constexpr std::string_view kConstant = "the byte never changes";
constexpr std::string_view kAlwaysOne = "the bit is always 1";
constexpr std::string_view kAlwaysZero = "the bit is always 0 in this profile";
constexpr std::string_view kUnread = "the board never looks at it";
constexpr std::string_view kUndefined = "the gripper gives the bit no meaning";
constexpr std::string_view kNobodyThere =
    "no gripper answers then, as if there were none on the board's CAN";
constexpr std::string_view kDoesNothing = "neither code does anything in this state";
constexpr std::array kEquivalents{
    Equivalent{"bit-high:homed.1", kAlwaysOne},
    Equivalent{"bit-high:homed.0", kAlwaysOne},
    Equivalent{"bit-high:io.2", kAlwaysOne},
    Equivalent{"bit-high:io.1", kAlwaysOne},
    Equivalent{"bit-high:io.0", kAlwaysOne},
    Equivalent{"bit-high:temperature_error.1", kAlwaysOne},
    Equivalent{"bit-high:temperature_error.0", kAlwaysOne},
    Equivalent{"bit-high:position_error.1", kAlwaysOne},
    Equivalent{"bit-high:position_error.0", kAlwaysOne},
    Equivalent{"bit-low:temperature_error.7", kAlwaysZero},
    Equivalent{"bit-low:temperature_error.6", kAlwaysZero},
    Equivalent{"bit-low:temperature_error.5", kAlwaysZero},
    Equivalent{"bit-low:temperature_error.4", kAlwaysZero},
    Equivalent{"bit-low:temperature_error.3", kAlwaysZero},
    Equivalent{"bit-low:temperature_error.2", kAlwaysZero},
    Equivalent{"bit-low:position_error.7", kAlwaysZero},
    Equivalent{"bit-low:position_error.6", kAlwaysZero},
    Equivalent{"bit-low:position_error.5", kAlwaysZero},
    Equivalent{"bit-low:position_error.4", kAlwaysZero},
    Equivalent{"bit-low:position_error.3", kAlwaysZero},
    Equivalent{"bit-low:position_error.2", kAlwaysZero},
    Equivalent{"stuck:temperature_error", kConstant},
    Equivalent{"stale:temperature_error", kConstant},
    Equivalent{"stuck:position_error", kConstant},
    Equivalent{"stale:position_error", kConstant},
    Equivalent{"stuck:timeout_error", kConstant},
    Equivalent{"stale:timeout_error", kConstant},
    Equivalent{"zero:gripper.id", kConstant},
    Equivalent{"stuck:gripper.id", kConstant},
    Equivalent{"stale:gripper.id", kConstant},
    Equivalent{"reverse-bits:gripper.id", kConstant},
    Equivalent{"stuck:gripper.speed", kConstant},
    Equivalent{"stale:gripper.speed", kConstant},
    Equivalent{"stuck:gripper.object", kConstant},
    Equivalent{"stale:gripper.object", kConstant},
    Equivalent{"stuck:check", kConstant},
    Equivalent{"stale:check", kConstant},
    Equivalent{"bit-low:gripper.status.3", "no gripper on the bench is ever too hot"},
    Equivalent{"bit-low:gripper.status.2", "no gripper on the bench ever times out"},
    Equivalent{"off-by-one:timing", "a tick is less than a pass of the board's loop"},
    Equivalent{"in.zero:timeout", kUnread},
    Equivalent{"in.stuck:timeout", kUnread},
    Equivalent{"in.stale:timeout", kUnread},
    Equivalent{"in.off-by-one:timeout", kUnread},
    Equivalent{"in.reverse-bits:timeout", kUnread},
    Equivalent{"in.bit-low:in_out.7", kUnread},
    Equivalent{"in.bit-high:in_out.7", kUnread},
    Equivalent{"in.bit-low:in_out.6", kUnread},
    Equivalent{"in.bit-high:in_out.6", kUnread},
    Equivalent{"in.bit-low:in_out.3", kUnread},
    Equivalent{"in.bit-high:in_out.3", kUnread},
    Equivalent{"in.bit-low:in_out.2", kUnread},
    Equivalent{"in.bit-high:in_out.2", kUnread},
    Equivalent{"in.bit-low:in_out.1", kUnread},
    Equivalent{"in.bit-high:in_out.1", kUnread},
    Equivalent{"in.bit-low:in_out.0", kUnread},
    Equivalent{"in.bit-high:in_out.0", kUnread},
    Equivalent{"in.bit-low:gripper.command.3", kUndefined},
    Equivalent{"in.bit-high:gripper.command.3", kUndefined},
    Equivalent{"in.bit-low:gripper.command.2", kUndefined},
    Equivalent{"in.bit-high:gripper.command.2", kUndefined},
    Equivalent{"in.bit-low:gripper.command.1", kUndefined},
    Equivalent{"in.bit-high:gripper.command.1", kUndefined},
    Equivalent{"in.bit-low:gripper.command.0", kUndefined},
    Equivalent{"in.bit-high:gripper.command.0", kUndefined},
    Equivalent{"in.negated:gripper.current", "the gripper takes the magnitude"},
    Equivalent{"in.stale:gripper.current", "the frame that asks for the answer brings it"},
    Equivalent{"in.off-by-one:gripper.mode", kNobodyThere},
    Equivalent{"in.off-by-one:gripper.id", kNobodyThere},
    Equivalent{"row:disabled.home.unknown", kDoesNothing},
    Equivalent{"row:disabled.home.disable", kDoesNothing},
    Equivalent{"row:disabled.disable.unknown", kDoesNothing},
    Equivalent{"row:disabled.clear.unknown", "enable, the only way out, forgets the stages too"},
    Equivalent{"row:disabled.clear.disable", "enable, the only way out, forgets the stages too"},
    Equivalent{"row:disabled.jog.unknown", kDoesNothing},
    Equivalent{"row:disabled.jog.disable", kDoesNothing},
    Equivalent{"row:disabled.go-to.unknown", kDoesNothing},
    Equivalent{"row:disabled.go-to.disable", kDoesNothing},
    Equivalent{"row:disabled.unknown.disable", kDoesNothing},
    Equivalent{"row:homing.home.kept", "home and idle both go on with homing"},
    Equivalent{"row:homing.home.idle", "home and idle both go on with homing"},
};

struct Hints {
  std::string_view section;
  std::array<std::string_view, 4> requirements;
};
constexpr std::array kHints{
    Hints{"Telemetry", {"parol6.telemetry", "parol6.jog", "parol6.telemetry", "parol6.frame"}},
    Hints{"Command frame", {"parol6.jog", "parol6.goto", "parol6.command", "parol6.telemetry"}},
    Hints{"Commands", {"parol6.command", "parol6.jog", "parol6.home", "parol6.goto"}},
    Hints{"Jog", {"parol6.jog", "parol6.jog", "parol6.jog", "parol6.jog"}},
    Hints{"Go-to law", {"parol6.goto", "parol6.goto", "parol6.goto", "parol6.goto"}},
    Hints{"Homing", {"parol6.home", "parol6.home", "parol6.home", "parol6.home"}},
    Hints{"Demonstration", {"parol6.demo", "parol6.demo", "parol6.demo", "parol6.demo"}},
    Hints{"Gripper",
          {"parol6.gripper", "parol6.telemetry.gripper", "parol6.passive", "parol6.telemetry"}},
    Hints{"Inputs and outputs",
          {"parol6.io", "parol6.outputs", "parol6.telemetry", "parol6.passive"}},
    Hints{"Timing",
          {"parol6.telemetry.timing", "parol6.timing", "parol6.telemetry.timing", "parol6.timing"}},
    Hints{"Receiving", {"parol6.receive", "parol6.frame", "parol6.loop", "parol6.robust"}},
    Hints{"Link", {"parol6.frame", "parol6.link", "parol6.rate", "parol6.robust"}},
    Hints{"Profile", {"parol6.receive", "parol6.command", "parol6.home", "parol6.gripper"}},
};

}  // namespace

std::vector<Mutant> all_mutants() {
  std::vector<Mutant> all;
  for (auto& fault : all_faults()) {
    Mutant mutant{std::move(fault.name), std::move(fault.section)};
    const auto known = std::ranges::find(kEquivalents, mutant.name, &Equivalent::name);
    if (known != kEquivalents.end()) mutant.equivalent = known->reason;
    all.push_back(std::move(mutant));
  }
  return all;
}

std::span<const std::string_view> mutant_hints(std::string_view section) {
  const auto hints = std::ranges::find(kHints, section, &Hints::section);
  if (hints == kHints.end()) return {};
  return hints->requirements;
}

}  // namespace armjig::parol6
