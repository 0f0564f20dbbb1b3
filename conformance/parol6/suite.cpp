// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/suite.hpp"

#include <array>
#include <utility>

#include "conformance/parol6/board_bench.hpp"
#include "conformance/parol6/chapters.hpp"
#include "conformance/parol6/host/check.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr std::array kStarts{
    StartState{"listening", Hazard::kObserve},
    StartState{"fresh from power-up", Hazard::kState},
    StartState{"homed", Hazard::kHome},
    StartState{"enabled", Hazard::kState},
};

}  // namespace

Suite suite() noexcept {
  static const std::array kChapters{
      Chapter{"Frames", frame_requirements(), frame_cases()},
      Chapter{"Receiving", receive_requirements(), receive_cases()},
      Chapter{"Telemetry", telemetry_requirements(), telemetry_cases()},
      Chapter{"Inputs, outputs and emergency stop", io_requirements(), io_cases()},
      Chapter{"Commands", command_requirements(), command_cases()},
      Chapter{"Jog and stepping", jog_requirements(), jog_cases()},
      Chapter{"Go-to law", go_to_requirements(), go_to_cases()},
      Chapter{"Homing, a whole run", home_run_requirements(), home_run_cases()},
      Chapter{"Homing, interrupted and repeated", home_requirements(), home_cases()},
      Chapter{"Demonstration", demo_requirements(), demo_cases()},
      Chapter{"Gripper", gripper_requirements(), gripper_cases()},
      Chapter{"Between the chapters", {}, between_cases()},
      Chapter{"Host programs", programs::host_requirements(), {}},
  };
  return {"parol6", "0.3", kChapters, kStarts, shipped_document("docs/spec/parol6.md")};
}

Outcome<std::unique_ptr<Bench>> make_bench(Rig<StreamPort> rig, const RigOptions& /*how*/) {
  return std::make_unique<BoardBench>(std::move(rig));
}

}  // namespace armjig::parol6::conformance
