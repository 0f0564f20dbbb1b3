// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/suite.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "conformance/parol6/board_bench.hpp"
#include "conformance/parol6/chapters.hpp"
#include "conformance/parol6/host/check.hpp"
#include "conformance/sessions.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr std::array kStarts{
    StartState{"listening", Hazard::kObserve},
    StartState{"fresh from power-up", Hazard::kState},
    StartState{"homed", Hazard::kHome},
    StartState{"enabled", Hazard::kState},
};

constexpr std::array kSubjects{
    Subject{"telemetry", "message", "parol6.frame.one-answer"},
    Subject{"telemetry", "time", "parol6.frame.prompt"},
    Subject{"telemetry", "bytes", "parol6.telemetry.layout"},
    Subject{"telemetry", "position", "parol6.telemetry.position-own-joint"},
    Subject{"telemetry", "speed", "parol6.telemetry.speed-own-joint"},
    Subject{"telemetry", "homed", "parol6.home.bits"},
    Subject{"telemetry", "io", "parol6.io.sampled"},
    Subject{"telemetry", "temperature_error", "parol6.telemetry.temperature-error"},
    Subject{"telemetry", "position_error", "parol6.telemetry.no-position-error"},
    Subject{"telemetry", "timing", "parol6.telemetry.timing"},
    Subject{"telemetry", "timeout_error", "parol6.telemetry.timeout-error"},
    Subject{"telemetry", "echo", "parol6.telemetry.echo"},
    Subject{"telemetry", "gripper", "parol6.gripper.latest"},
    Subject{"telemetry", "gripper.id", "parol6.telemetry.gripper-id"},
    Subject{"telemetry", "gripper.speed", "parol6.telemetry.gripper-speed"},
    Subject{"telemetry", "gripper.object", "parol6.telemetry.gripper-object"},
    Subject{"telemetry", "check", "parol6.telemetry.check"},
};

/// All ways to stop, from every state.
constexpr auto kVital = std::to_array<std::string_view>(
    {".command.disable-stops", ".command.enable-stops", ".command.clear-stops", ".command.idle-st",
     ".command.unknown", ".command.disabled-", ".goto.stops", ".home.ended-by-", ".io.estop-",
     ".gripper.stop", ".gripper.while-disabled"});

}  // namespace

Suite suite() noexcept {
  // A whole run of homing leaves the arm at places from which interrupted ones show less.
  static const std::array kChapters{
      frame_chapter(),
      receive_chapter(),
      telemetry_chapter(),
      io_chapter(),
      command_chapter(),
      jog_chapter(),
      go_to_chapter(),
      home_chapter(),
      home_run_chapter(),
      demo_chapter(),
      gripper_chapter(),
      set_point_chapter(),
      sessions_chapter("parol6.sessions.as-reference", "firmware, as the emulator has it"),
      chapter("Host programs", programs::host_requirements()),
  };
  return {"parol6",  "0.3", kChapters, kStarts, shipped_document("docs/spec/parol6.md"),
          kSubjects, kVital};
}

Outcome<std::unique_ptr<Bench>> make_bench(Rig<StreamPort> rig, const RigOptions& /*how*/) {
  return std::make_unique<BoardBench>(std::move(rig));
}

}  // namespace armjig::parol6::conformance
