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
      bus_chapter(),        reading_chapter(), status_chapter(),
      reference_chapter(),  output_chapter(),  program_chapter(),
      tune_chapter(),       loop_chapter(),    motion_chapter(),
      documented_chapter(), pen_chapter(),     chapter("Masters", programs::host_requirements()),
  };
  return {"morap", "0.3", kChapters, kStarts, shipped_document("docs/spec/morap.md")};
}

}  // namespace armjig::morap::conformance
