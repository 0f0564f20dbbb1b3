// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "conformance/kinovazed/suite.hpp"
#include "emulators/kinovazed/defects/faults.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr std::string_view kUnknown = "the document does not have it";
constexpr std::array kEquivalents{
    EquivalentFault{"bit-high:0", "a healthy server always sets bit 0"},
    EquivalentFault{"deaf:FindBottle", kUnknown, armjig::Profile::kDocumented},
    EquivalentFault{"deaf:PlaceBottle", kUnknown, armjig::Profile::kDocumented},
    EquivalentFault{"row:idle.Initialize.rejected",
                    "it is confirmed at once, without a look at the table",
                    armjig::Profile::kDocumented},
};

constexpr std::array kHints{
    SectionHints{"Connections", {"kinovazed.connection", "kinovazed.line", "kinovazed.reply"}},
    SectionHints{"Lines", {"kinovazed.line", "kinovazed.robust", "kinovazed.reply"}},
    SectionHints{"Commands", {"kinovazed.console", "kinovazed.state", "kinovazed.line"}},
    SectionHints{"States", {"kinovazed.state"}},
    SectionHints{"Replies and events",
                 {"kinovazed.reply", "kinovazed.state", "kinovazed.interrupt"}},
    SectionHints{"Interrupts and ends",
                 {"kinovazed.event", "kinovazed.interrupt", "kinovazed.state"}},
    SectionHints{"Heartbeats", {"kinovazed.beat", "kinovazed.state", "kinovazed.connection"}},
    SectionHints{"Joystick", {"kinovazed.joystick", "kinovazed.mode", "kinovazed.state"}},
    SectionHints{"Objectives", {"kinovazed.objective", "kinovazed.state", "kinovazed.interrupt"}},
    SectionHints{"Times", {"kinovazed.beat", "kinovazed.mode", "kinovazed.time"}},
    SectionHints{"Robustness", {"kinovazed.robust", "kinovazed.line", "kinovazed.reply"}},
};

}  // namespace

MutantsEntry mutants_entry() noexcept {
  return {"kinovazed", emulation::all_faults, kEquivalents, kHints};
}

}  // namespace armjig::kinovazed::conformance
