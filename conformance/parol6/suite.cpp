// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/suite.hpp"

#include <array>
#include <utility>

#include "conformance/parol6/board_bench.hpp"
#include "conformance/parol6/chapters.hpp"
#include "conformance/parol6/host/checker.hpp"
#include "emulators/host/devices.hpp"

namespace armjig::parol6 {
namespace {

constexpr std::array kStarts{
    StartState{"listening", Hazard::kObserve},
    StartState{"fresh from power-up", Hazard::kState},
    StartState{"enabled", Hazard::kState},
    StartState{"homed", Hazard::kHome},
};

Outcome<std::unique_ptr<Bench>> open(const RigOptions& how) {
  auto rig = Rig::open("parol6", how, hosted_device("parol6").open);
  if (!rig) return tl::unexpected{rig.error()};
  return std::make_unique<BoardBench>(*std::move(rig));
}

}  // namespace

Suite suite() noexcept {
  static const std::array kChapters{
      Chapter{"Frames", frame_requirements(), frame_cases()},
      Chapter{"Telemetry", telemetry_requirements(), telemetry_cases()},
      Chapter{"Host programs", host_requirements(), {}},
  };
  return {"parol6", "0.2", kChapters, kStarts, open};
}

}  // namespace armjig::parol6
