// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/suite.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "conformance/kinovazed/chapters.hpp"
#include "conformance/kinovazed/host/check.hpp"
#include "conformance/kinovazed/server_bench.hpp"
#include "conformance/sessions.hpp"

namespace armjig::kinovazed::conformance {
namespace {

/// In the order of `Start`.
constexpr std::array kStarts{
    StartState{"emergencyStopped", Hazard::kObserve},
    StartState{"poweredOff", Hazard::kState},
    StartState{"idle, the arm at its ready pose", Hazard::kMove},
    StartState{"steering in mode XYZ", Hazard::kMove},
    StartState{"retracted", Hazard::kMove},
    StartState{"just started", Hazard::kObserve},
};

constexpr std::array kSubjects{
    Subject{"Heartbeat", "message", "kinovazed.beat.single"},
    Subject{"Heartbeat", "time", "kinovazed.beat.period"},
    Subject{"Heartbeat", "state", "kinovazed.beat.values"},
    Subject{"Heartbeat", "bytes", "kinovazed.reply.words"},
    Subject{"Accepted", "message", "kinovazed.reply.one"},
    Subject{"Accepted", "time", "kinovazed.time.answer"},
    Subject{"Rejected", "message", "kinovazed.reply.one"},
    Subject{"Rejected", "time", "kinovazed.time.answer"},
    Subject{"Initialized", "message", "kinovazed.event.table"},
    Subject{"Retracted", "message", "kinovazed.event.table"},
    Subject{"Unfolded", "message", "kinovazed.event.table"},
    Subject{"Freezed", "message", "kinovazed.reply.prompt"},
    Subject{"JoystickModeSet", "message", "kinovazed.mode.settles"},
    Subject{"ObjectiveDone", "message", "kinovazed.objective.reached"},
    Subject{"ObjectiveDone", "time", "kinovazed.objective.takes-its-time"},
};

/// All ways to stop, from every state.
constexpr auto kVital =
    std::to_array<std::string_view>({".estop", ".interrupt.mode-stops", ".stopped-by-"});

}  // namespace

Suite suite() noexcept {
  static const std::array kChapters{
      state_chapter(),
      connection_chapter(),
      line_chapter(),
      long_line_chapter(),
      reply_chapter(),
      interrupt_chapter(),
      beat_chapter(),
      mode_chapter(),
      joystick_chapter(),
      objective_chapter(),
      arm_chapter(),
      robust_chapter(),
      death_chapter(),
      sessions_chapter("kinovazed.sessions.as-reference", "server, as the emulator has it"),
      chapter("Client programs", programs::host_requirements()),
  };
  return {"kinovazed", "0.3", kChapters, kStarts, shipped_document("docs/spec/kinovazed.md"),
          kSubjects,   kVital};
}

Outcome<std::unique_ptr<Bench>> make_bench(Rig<SessionSource> rig, const RigOptions& how) {
  const bool may_stop = how.target.is_emulated() || how.permissions.allow(Hazard::kState);
  auto bench = std::make_unique<ServerBench>(
      std::move(rig), may_stop ? ServerBench::MayStop::kYes : ServerBench::MayStop::kNo);
  if (const auto begun = bench->begin_session(); !begun) {
    return problem(begun.error().code, how.target.text, "is the server running, with its arm?");
  }
  return bench;
}

}  // namespace armjig::kinovazed::conformance
