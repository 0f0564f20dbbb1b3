// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/suite.hpp"

#include <array>
#include <string_view>

#include "conformance/morap/chapters.hpp"
#include "conformance/morap/host/check.hpp"
#include "conformance/sessions.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr std::array kStarts{
    StartState{"listening", Hazard::kObserve},
    StartState{"uncalibrated", Hazard::kState},
    StartState{"disabled", Hazard::kState},
    StartState{"disabled, with the stored controllers", Hazard::kProgram},
    StartState{"fresh from power-up, the shaft held", Hazard::kState},
    StartState{"calibrated, the shaft free", Hazard::kProgram},
    StartState{"calibrated, the shaft free, for slow loops", Hazard::kProgram},
    StartState{"switched on", Hazard::kState},
};

constexpr std::array kSubjects{
    Subject{{}, "note", "morap.bus.acknowledges"},
    Subject{"angle", "angle", "morap.angle.scale"},
    Subject{"position_reference", "position_reference", "morap.reference.position"},
    Subject{"speed_reference", "speed_reference", "morap.reference.speed"},
    Subject{"motor_status", "motor_status", "morap.status.at-boot"},
    Subject{"programming_status", "programming_status", "morap.program.status-at-boot"},
    Subject{"applied_voltage", "applied_voltage", "morap.voltage.close"},
    Subject{"current", "current", "morap.current.scale"},
    Subject{"own_address", "own_address", "morap.read.address"},
    Subject{"position_set", "checksum", "morap.read.set-checksum"},
    Subject{"speed_set", "checksum", "morap.read.set-checksum"},
};

/// All ways to stop, from every state.
constexpr auto kVital = std::to_array<std::string_view>(
    {".voltage.disabled", ".voltage.forgotten", ".voltage.uncalibrated", ".motion.disabled",
     ".motion.latched", ".motion.ends", ".motion.forgotten", ".motion.open-loop"});

}  // namespace

Suite suite() noexcept {
  static const std::array kChapters{
      bus_chapter(),
      reading_chapter(),
      status_chapter(),
      reference_chapter(),
      output_chapter(),
      program_chapter(),
      stored_chapter(),
      tune_chapter(),
      loop_chapter(),
      loop_mode_chapter(),
      motion_chapter(),
      documented_chapter(),
      pen_chapter(),
      sessions_chapter("morap.sessions.as-reference", "firmware, as the emulator has it"),
      chapter("Masters", programs::host_requirements()),
  };
  return {"morap",   "0.3", kChapters, kStarts, shipped_document("docs/spec/morap.md"),
          kSubjects, kVital};
}

}  // namespace armjig::morap::conformance
