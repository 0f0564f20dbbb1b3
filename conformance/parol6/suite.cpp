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
  // A whole run of homing leaves the arm at places from which interrupted ones show less.
  static const std::array kChapters{
      frame_chapter(), receive_chapter(), telemetry_chapter(),
      io_chapter(),    command_chapter(), jog_chapter(),
      go_to_chapter(), home_chapter(),    home_run_chapter(),
      demo_chapter(),  gripper_chapter(), chapter("Host programs", programs::host_requirements()),
  };
  return {"parol6", "0.3", kChapters, kStarts, shipped_document("docs/spec/parol6.md")};
}

Outcome<std::unique_ptr<Bench>> make_bench(Rig<StreamPort> rig, const RigOptions& /*how*/) {
  return std::make_unique<BoardBench>(std::move(rig));
}

}  // namespace armjig::parol6::conformance
