// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/mutants.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "emulators/morap/defects/defects.hpp"

namespace armjig::morap {
namespace {

/// Why a mutant is no mutant.
struct Equivalent {
  std::string_view name;
  std::string_view reason;
};
constexpr auto kEquivalents = std::to_array<Equivalent>({
    {"eeprom:inductance", "it is stored and never used"},
    {"in:off-by-one:voltage.value", "the last bit of a voltage is less than a level"},
    {"in:off-by-one:torque.value", "the last bit of a torque is less than a level"},
    {"in:off-by-one:calibrate_angle.value", "the last bit of an angle is less than a count"},
    {"row:needs-calibration.disable.forget", "both take the mode away, and nothing else is left"},
    {"row:needs-calibration.calibration_unknown.disable",
     "both take the mode away, and nothing else is left"},
});

struct Hints {
  std::string_view section;
  std::array<std::string_view, 4> requirements;
};
constexpr std::array kHints{
    Hints{"Bus", {"morap.bus", "morap.bus", "morap.bus", "morap.bus"}},
    Hints{"Reading", {"morap.read", "morap.reference", "morap.status", "morap.voltage"}},
    Hints{"Commands", {"morap.status", "morap.ids", "morap.brake", "morap.read"}},
    Hints{"Status", {"morap.status", "morap.calibrate", "morap.voltage", "morap.program"}},
    Hints{"Writing", {"morap.write", "morap.status", "morap.program", "morap.tune"}},
    Hints{"References", {"morap.reference", "morap.voltage", "morap.torque", "morap.calibrate"}},
    Hints{"Calibration", {"morap.calibrate", "morap.angle", "morap.status", "morap.read"}},
    Hints{"Output", {"morap.voltage", "morap.direct", "morap.torque", "morap.current"}},
    Hints{"Programming", {"morap.program", "morap.checksum", "morap.defaults", "morap.loop"}},
    Hints{"Tuning", {"morap.tune", "morap.tune", "morap.tune", "morap.tune"}},
    Hints{"Feedback", {"morap.loop", "morap.program", "morap.loop", "morap.loop"}},
    Hints{"Control law", {"morap.loop", "morap.voltage", "morap.torque", "morap.tick"}},
    Hints{"Stored figures", {"morap.read", "morap.tune", "morap.voltage", "morap.calibrate"}},
    Hints{"Profile", {"morap.program", "morap.tune", "morap.brake", "morap.direct"}},
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

}  // namespace armjig::morap
