// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "conformance/parol6/suite.hpp"
#include "emulators/parol6/defects/defects.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr std::string_view kConstant = "the byte never changes";
constexpr std::string_view kAlwaysOne = "the bit is always 1";
constexpr std::string_view kAlwaysZero = "the bit is always 0 in this profile";
constexpr std::string_view kUnread = "the board never looks at it";
constexpr std::string_view kUndefined = "the gripper gives the bit no meaning";
constexpr std::string_view kNobodyThere =
    "no gripper answers then, as if there were none on the board's CAN";
constexpr std::string_view kDoesNothing = "neither code does anything in this state";
constexpr std::string_view kAfresh = "homing begins anew without an enable, too";
constexpr std::array kEquivalents{
    EquivalentFault{"bit-high:homed.1", kAlwaysOne},
    EquivalentFault{"bit-high:homed.0", kAlwaysOne},
    EquivalentFault{"bit-high:io.2", kAlwaysOne},
    EquivalentFault{"bit-high:io.1", kAlwaysOne},
    EquivalentFault{"bit-high:io.0", kAlwaysOne},
    EquivalentFault{"bit-high:temperature_error.1", kAlwaysOne},
    EquivalentFault{"bit-high:temperature_error.0", kAlwaysOne},
    EquivalentFault{"bit-high:position_error.1", kAlwaysOne},
    EquivalentFault{"bit-high:position_error.0", kAlwaysOne},
    EquivalentFault{"bit-low:temperature_error.7", kAlwaysZero},
    EquivalentFault{"bit-low:temperature_error.6", kAlwaysZero},
    EquivalentFault{"bit-low:temperature_error.5", kAlwaysZero},
    EquivalentFault{"bit-low:temperature_error.4", kAlwaysZero},
    EquivalentFault{"bit-low:temperature_error.3", kAlwaysZero},
    EquivalentFault{"bit-low:temperature_error.2", kAlwaysZero},
    EquivalentFault{"bit-low:position_error.7", kAlwaysZero},
    EquivalentFault{"bit-low:position_error.6", kAlwaysZero},
    EquivalentFault{"bit-low:position_error.5", kAlwaysZero},
    EquivalentFault{"bit-low:position_error.4", kAlwaysZero},
    EquivalentFault{"bit-low:position_error.3", kAlwaysZero},
    EquivalentFault{"bit-low:position_error.2", kAlwaysZero},
    EquivalentFault{"stuck:temperature_error", kConstant},
    EquivalentFault{"stale:temperature_error", kConstant},
    EquivalentFault{"stuck:position_error", kConstant},
    EquivalentFault{"stale:position_error", kConstant},
    EquivalentFault{"stuck:timeout_error", kConstant},
    EquivalentFault{"stale:timeout_error", kConstant},
    EquivalentFault{"zero:gripper.id", kConstant},
    EquivalentFault{"stuck:gripper.id", kConstant},
    EquivalentFault{"stale:gripper.id", kConstant},
    EquivalentFault{"reverse-bits:gripper.id", kConstant},
    EquivalentFault{"stuck:gripper.speed", kConstant},
    EquivalentFault{"stale:gripper.speed", kConstant},
    EquivalentFault{"stuck:gripper.object", kConstant},
    EquivalentFault{"stale:gripper.object", kConstant},
    EquivalentFault{"stuck:check", kConstant},
    EquivalentFault{"stale:check", kConstant},
    EquivalentFault{"bit-low:gripper.status.3", "no gripper on the bench is ever too hot"},
    EquivalentFault{"bit-low:gripper.status.2", "no gripper on the bench ever times out"},
    EquivalentFault{"off-by-one:timing", "a tick is less than a pass of the board's loop"},
    EquivalentFault{"in.zero:timeout", kUnread},
    EquivalentFault{"in.stuck:timeout", kUnread},
    EquivalentFault{"in.stale:timeout", kUnread},
    EquivalentFault{"in.off-by-one:timeout", kUnread},
    EquivalentFault{"in.reverse-bits:timeout", kUnread},
    EquivalentFault{"in.bit-low:in_out.7", kUnread},
    EquivalentFault{"in.bit-high:in_out.7", kUnread},
    EquivalentFault{"in.bit-low:in_out.6", kUnread},
    EquivalentFault{"in.bit-high:in_out.6", kUnread},
    EquivalentFault{"in.bit-low:in_out.3", kUnread},
    EquivalentFault{"in.bit-high:in_out.3", kUnread},
    EquivalentFault{"in.bit-low:in_out.2", kUnread},
    EquivalentFault{"in.bit-high:in_out.2", kUnread},
    EquivalentFault{"in.bit-low:in_out.1", kUnread},
    EquivalentFault{"in.bit-high:in_out.1", kUnread},
    EquivalentFault{"in.bit-low:in_out.0", kUnread},
    EquivalentFault{"in.bit-high:in_out.0", kUnread},
    EquivalentFault{"in.bit-low:gripper.command.3", kUndefined},
    EquivalentFault{"in.bit-high:gripper.command.3", kUndefined},
    EquivalentFault{"in.bit-low:gripper.command.2", kUndefined},
    EquivalentFault{"in.bit-high:gripper.command.2", kUndefined},
    EquivalentFault{"in.bit-low:gripper.command.1", kUndefined},
    EquivalentFault{"in.bit-high:gripper.command.1", kUndefined},
    EquivalentFault{"in.bit-low:gripper.command.0", kUndefined},
    EquivalentFault{"in.bit-high:gripper.command.0", kUndefined},
    EquivalentFault{"in.negated:gripper.current", "the gripper takes the magnitude"},
    EquivalentFault{"in.stale:gripper.current", "the frame that asks for the answer brings it"},
    EquivalentFault{"in.off-by-one:gripper.mode", kNobodyThere},
    EquivalentFault{"in.off-by-one:gripper.id", kNobodyThere},
    EquivalentFault{"row:disabled.home.unknown", kDoesNothing},
    EquivalentFault{"row:disabled.home.disable", kDoesNothing},
    EquivalentFault{"row:disabled.disable.unknown", kDoesNothing},
    EquivalentFault{"row:disabled.clear.unknown",
                    "enable, the only way out, forgets the stages too"},
    EquivalentFault{"row:disabled.clear.disable",
                    "enable, the only way out, forgets the stages too"},
    EquivalentFault{"row:disabled.jog.unknown", kDoesNothing},
    EquivalentFault{"row:disabled.jog.disable", kDoesNothing},
    EquivalentFault{"row:disabled.go-to.unknown", kDoesNothing},
    EquivalentFault{"row:disabled.go-to.disable", kDoesNothing},
    EquivalentFault{"row:disabled.unknown.disable", kDoesNothing},
    EquivalentFault{"row:homing.home.kept", "home and idle both go on with homing"},
    EquivalentFault{"row:homing.home.idle", "home and idle both go on with homing"},
    EquivalentFault{"row:enabled.enable.unknown", kAfresh, Profile::kDocumented},
    EquivalentFault{"row:enabled.enable.idle", kAfresh, Profile::kDocumented},
};

constexpr std::array kHints{
    SectionHints{"Telemetry", {"parol6.telemetry", "parol6.jog", "parol6.frame"}},
    SectionHints{"Command frame",
                 {"parol6.jog", "parol6.goto", "parol6.command", "parol6.telemetry"}},
    SectionHints{"Commands", {"parol6.command", "parol6.jog", "parol6.home", "parol6.goto"}},
    SectionHints{"Jog", {"parol6.jog"}},
    SectionHints{"Go-to law", {"parol6.goto"}},
    SectionHints{"Homing", {"parol6.home"}},
    SectionHints{"Demonstration", {"parol6.demo"}},
    SectionHints{
        "Gripper",
        {"parol6.gripper", "parol6.telemetry.gripper", "parol6.passive", "parol6.telemetry"}},
    SectionHints{"Inputs and outputs",
                 {"parol6.io", "parol6.outputs", "parol6.telemetry", "parol6.passive"}},
    SectionHints{"Timing", {"parol6.telemetry.timing", "parol6.timing"}},
    SectionHints{"Receiving", {"parol6.receive", "parol6.frame", "parol6.loop", "parol6.robust"}},
    SectionHints{"Link", {"parol6.frame", "parol6.link", "parol6.rate", "parol6.robust"}},
    SectionHints{"Profile", {"parol6.receive", "parol6.command", "parol6.home", "parol6.gripper"}},
};

}  // namespace

MutantsEntry mutants_entry() noexcept {
  return {"parol6", emulation::all_faults, kEquivalents, kHints};
}

}  // namespace armjig::parol6::conformance
