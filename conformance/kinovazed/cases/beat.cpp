// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum emulation::State;

template <emulation::State state>
void value(ServerBench& server) {
  enter(server, state);
  server.expect_beat(beat_of(state));
}

/// The median forgives a machine that stands still for a moment.
void period(ServerBench& server) {
  std::array<Duration, 5> periods{};
  auto last = server.await_beat().time;
  for (auto& each : periods) {
    const auto beat = server.await_beat_behind(last).time;
    each = beat - std::exchange(last, beat);
  }
  std::ranges::nth_element(periods, periods.begin() + 2);
  server.about("the median of five periods");
  expect_time(server, periods[2], 985ms - server.noise(), 1040ms + server.noise());
}

void single(ServerBench& server) {
  (void)server.await_beat();
  const auto count = server.count_beats(4500ms);
  server.expect_true(count == 4, "4 beats within 4.5 s", std::to_string(count));
}

/// From one resting state to the next, by the way that the document tells.
void values(ServerBench& server) {
  constexpr std::array kHealthy{1, 3, 5, 13, 21, 37, 69, 133};
  for (const auto* command : {"Retract", "EStop", "QuitEStop", "Initialize"}) {
    server.say(command);
    for (int i = 0; i < 2; ++i) {
      const auto message = server.await_beat().message;
      const auto* const beat = std::get_if<Heartbeat>(&message);
      const bool is_healthy =
          beat != nullptr && std::ranges::find(kHealthy, beat->flags) != kHealthy.end();
      server.expect_true(is_healthy, "1, 3, 5, 13, 21, 37, 69 or 133",
                         beat == nullptr ? "none" : std::to_string(beat->flags));
    }
  }
}

void decimal(ServerBench& server) {
  server.expect_beat(3);
  server.expect_beat(3);
}

void during_commands(ServerBench& server) {
  const auto first = server.await_beat();
  auto last = first;
  for (int i = 0; i < 3; ++i) {
    for (int command = 0; command < 12; ++command) {
      server.accept("EStop");
      server.pause(50ms);
    }
    last = server.await_beat();
  }
  expect_time(server, last.time - first.time, 2900ms, 3300ms + server.noise());
}

void initialized(ServerBench& server) {
  server.expect_beat(21);
  server.accept("EStop");
  server.expect_beat(3);
  server.accept("QuitEStop");
  server.expect_beat(1);
  server.perform("Initialize", Event::kInitialized);
  server.expect_beat(21);
}

/// The arm cannot be read and not be opened again, for a while.
void lose_arm(ServerBench& server) {
  server.spoil(ServerBench::Recovery::kByHand);
  server.touch("arm.fail.arm_open", -1);
  server.touch("arm.fail.status_read", 1);
  server.pause(150ms);
}

void find_arm(ServerBench& server) { server.touch("arm.fail.arm_open", 0); }

void lost_arm(ServerBench& server) {
  lose_arm(server);
  server.about("while the arm is lost");
  server.expect_no_message(2500ms);
  find_arm(server);
  server.expect_beat(3);
}

void shows_lost_arm(ServerBench& server) {
  lose_arm(server);
  server.expect_beat(20);
  find_arm(server);
  server.pause(1s);
  server.expect_beat(3);
}

constexpr Case kCases[] = {
    in(kEmergencyStopped, "kinovazed.beat.period", "Most of five periods take 1 s.", on<period>),
    in(kEmergencyStopped, "kinovazed.beat.single", "Four beats within 4.5 s behind one.",
       on<single>),
    in(kIdle, "kinovazed.beat.values", "Eight beats on the way through four states.", on<values>),
    in(kEmergencyStopped, "kinovazed.beat.decimal", "Two beats are 3.", on<decimal>),
    in(kEmergencyStopped, "kinovazed.beat.during-commands",
       "Three beats among 36 commands come in their time.", on<during_commands>),
    in(kEmergencyStopped, "kinovazed.beat.stopped", "Beat 3.", on<value<kEmergencyStopped>>),
    in(kPoweredOff, "kinovazed.beat.off", "Beat 1.", on<value<kPoweredOff>>),
    in(kInitializing, "kinovazed.beat.initializing", "Beat 1.", on<value<kInitializing>>),
    in(kIdle, "kinovazed.beat.initializing-again", "Beat 5.", on<initialize_at_home>),
    in(kIdle, "kinovazed.beat.idle", "Beat 21.", on<value<kIdle>>),
    in(kRetracting, "kinovazed.beat.retracting", "Beat 5.", on<value<kRetracting>>),
    in(kRetracted, "kinovazed.beat.retracted", "Beat 133.", on<value<kRetracted>>),
    in(kUnfolding, "kinovazed.beat.unfolding", "Beat 5.", on<value<kUnfolding>>),
    in(kSettingMode, "kinovazed.beat.setting-mode", "Beat 5.", on<value<kSettingMode>>),
    in(kSteering, "kinovazed.beat.steering", "Beat 69.", on<value<kSteering>>),
    in(kRunningSequence, "kinovazed.beat.running", "Beat 37.", on<value<kRunningSequence>>),
    in(kFrozen, "kinovazed.beat.frozen", "Beat 13.", on<value<kFrozen>>),
    in(kIdle, "kinovazed.beat.initialized", "Beats 21, 3, 1 and 21.", on<initialized>),
    in(kIdle, "kinovazed.beat.lost-arm", "No beat for 2.5 s, then 3.", on<lost_arm>),
    in(kIdle, "kinovazed.beat.shows-lost-arm", "Beat 20, later 3.", on<shows_lost_arm>),
};

}  // namespace

std::span<const Case> beat_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
