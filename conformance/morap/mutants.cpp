// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "conformance/morap/suite.hpp"
#include "emulators/morap/defects/defects.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr auto kEquivalents = std::to_array<EquivalentFault>({
    {"eeprom:inductance", "it is stored and never used"},
    {"in:off-by-one:voltage.value", "the last bit of a voltage is less than a level"},
    {"in:off-by-one:torque.value", "the last bit of a torque is less than a level"},
    {"in:off-by-one:calibrate_angle.value", "the last bit of an angle is less than a count"},
    {"out:stuck:own_address.own_address", "a node keeps its address"},
    {"out:stale:own_address.own_address", "a node keeps its address"},
    {"out:zero:position_set.kind", "the kind of a position set is 0"},
    {"out:stuck:position_set.kind", "the kind of a position set is 0"},
    {"out:stale:position_set.kind", "the kind of a position set is 0"},
    {"out:doubled:position_set.kind", "the kind of a position set is 0"},
    {"out:reverse-bits:position_set.kind", "the kind of a position set is 0"},
    {"out:stuck:speed_set.kind", "a speed set is always of one kind"},
    {"out:stale:speed_set.kind", "a speed set is always of one kind"},
    {"row:needs-calibration.disable.forget", "both take the mode away, and nothing else is left"},
    {"row:needs-calibration.calibration_unknown.disable",
     "both take the mode away, and nothing else is left"},
});

constexpr std::array kHints{
    SectionHints{"Bus", {"morap.bus"}},
    SectionHints{"Reading", {"morap.read", "morap.reference", "morap.status", "morap.voltage"}},
    SectionHints{"Commands", {"morap.status", "morap.ids", "morap.brake", "morap.read"}},
    SectionHints{"Status", {"morap.status", "morap.calibrate", "morap.voltage", "morap.program"}},
    SectionHints{"Writing", {"morap.write", "morap.status", "morap.program", "morap.tune"}},
    SectionHints{"References",
                 {"morap.reference", "morap.voltage", "morap.torque", "morap.calibrate"}},
    SectionHints{"Calibration", {"morap.calibrate", "morap.angle", "morap.status", "morap.read"}},
    SectionHints{"Output", {"morap.voltage", "morap.direct", "morap.torque", "morap.current"}},
    SectionHints{"Programming",
                 {"morap.program", "morap.checksum", "morap.defaults", "morap.loop"}},
    SectionHints{"Tuning", {"morap.tune"}},
    SectionHints{"Feedback", {"morap.loop", "morap.program"}},
    SectionHints{"Control law", {"morap.loop", "morap.voltage", "morap.torque", "morap.tick"}},
    SectionHints{"Stored figures",
                 {"morap.read", "morap.tune", "morap.voltage", "morap.calibrate"}},
    SectionHints{"Pen", {"morap.pen"}},
    SectionHints{"Profile", {"morap.program", "morap.tune", "morap.brake", "morap.direct"}},
};

}  // namespace

MutantsEntry mutants_entry() noexcept {
  return {"morap", emulation::all_faults, kEquivalents, kHints, "pen=yes"};
}

}  // namespace armjig::morap::conformance
