// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/suite.hpp"

#include <array>

#include "conformance/morap/chapters.hpp"
#include "conformance/morap/host/check.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr std::array kStarts{
    StartState{"listening", Hazard::kObserve},
    StartState{"uncalibrated", Hazard::kState},
    StartState{"disabled", Hazard::kState},
    StartState{"disabled, with the stored controllers", Hazard::kProgram},
    StartState{"fresh from power-up, the shaft held", Hazard::kState},
    StartState{"calibrated, the shaft free", Hazard::kProgram},
};

}  // namespace

Suite suite() noexcept {
  static const std::array kChapters{
      Chapter{"Bus", bus_requirements(), bus_cases()},
      Chapter{"Reading", reading_requirements(), reading_cases()},
      Chapter{"Status and identifiers", status_requirements(), status_cases()},
      Chapter{"References, calibration and angle", reference_requirements(), reference_cases()},
      Chapter{"Output and ticks", output_requirements(), output_cases()},
      Chapter{"Programming", program_requirements(), program_cases()},
      Chapter{"Tuning", tune_requirements(), tune_cases()},
      Chapter{"Feedback loops", loop_requirements(), loop_cases()},
      Chapter{"A free shaft", motion_requirements(), motion_cases()},
      Chapter{"Where the document differs", documented_requirements(), documented_cases()},
      Chapter{"Pen", pen_requirements(), {}},
      Chapter{"Masters", programs::host_requirements(), {}},
  };
  return {"morap", "0.2", kChapters, kStarts, shipped_document("docs/spec/morap.md")};
}

}  // namespace armjig::morap::conformance
