// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum State;

template <State state>
void value(ServerBench& server) {
  enter(server, state);
  server.expect_beat(beat_of(state).flags);
}

/// The arm cannot be read and not be opened again, for a while.
void lose_arm(ServerBench& server) {
  server.spoil();
  server.touch("arm.fail.arm_open", -1);
  server.touch("arm.fail.status_read", 1);
  server.pause(150ms);
}

void find_arm(ServerBench& server) { server.touch("arm.fail.arm_open", 0); }

/// So many moves by nothing in one go, and the answers to all of them.
void flood(ServerBench& server, std::int64_t lines) {
  std::string text;
  for (std::int64_t i = 0; i < lines; ++i) text += "MoveJoystick:0:0:0\r\n";
  server.send(text);
  for (std::int64_t i = 0; i < lines && !server.is_over(); ++i) server.expect(Event::kAccepted);
}

/// Beats among the answers to lines that take two seconds and a half.
void expect_beats_in_flood(ServerBench& server) {
  constexpr std::int64_t kFew = 50;
  constexpr std::int64_t kMost = 8000;
  const auto begun = server.now();
  flood(server, kFew);
  const auto each = std::max<Duration>((server.now() - begun) / kFew, 1us);
  auto last = server.await_beat().time;
  flood(server, std::clamp<std::int64_t>(2500ms / each, kFew, kMost));
  const auto end = server.now();
  if (end - last < 2 * kBeatPeriod) {
    return server.leave_open("this server answers thousands of lines within two seconds");
  }
  server.about("a beat among the answers to a flood of lines");
  while (last + kBeatPeriod < end && !server.is_over()) {
    const auto beat = server.await_beat_behind(last).time;
    expect_time(server, beat - std::exchange(last, beat), 700ms, 1300ms + server.noise());
  }
}

/// A server is asked every 100 ms until it is there, so that it is known to that when it opened.
void expect_first_beat(ServerBench& server) {
  const auto [earliest, latest] = server.opened();
  const auto first = server.await_beat().time;
  server.about("the first beat, after the server opened its port");
  expect_time(server, first - earliest, kBeatPeriod - 15ms - server.noise(),
              kBeatPeriod + (latest - earliest) + 40ms + server.noise());
}

/// Half a second after a beat, so that one after the event would be too soon.
void expect_no_beat_with_events(ServerBench& server) {
  struct Row {
    const char* command;
    Event event;
  };
  for (const auto& [command, event] : {Row{"Freeze", Event::kFreezed},
                                       {"Unfreeze", Event::kUnfreezed},
                                       {"SetJoystickMode:NoMode", Event::kJoystickModeSet}}) {
    const auto before = server.await_beat().time;
    server.pause(500ms);
    server.perform(command, event);
    const auto after = server.await_beat_behind(before).time;
    server.about(fmt::format("from one beat to the next, with {} between", to_string(event)));
    expect_time(server, after - before, 900ms - server.noise(), 1200ms + server.noise());
  }
}

constexpr Clause kBeatClauses[] = {
    must("kinovazed.beat.period", "The next heartbeat comes 1 s after the one before.",
         "server, recording heartbeat-period"),
    /// The median forgives a machine that stands still for a moment.
    in(kEmergencyStopped, "Most of five periods take 1 s.",
       [](ServerBench& server) {
         std::array<Duration, 5> periods{};
         auto last = server.await_beat().time;
         for (auto& each : periods) {
           const auto beat = server.await_beat_behind(last).time;
           each = beat - std::exchange(last, beat);
         }
         std::ranges::nth_element(periods, periods.begin() + 2);
         server.about("the median of five periods");
         expect_time(server, periods[2], kBeatPeriod - 15ms - server.noise(),
                     kBeatPeriod + 40ms + server.noise());
       }),

    must("kinovazed.beat.first", "The first heartbeat comes 1 s after the server opened its port.",
         "server; reference 7"),
    from(kFresh, Hazard::kObserve, "Of a server that was just started.", on<expect_first_beat>),

    must("kinovazed.beat.single", "There is one heartbeat in each second, and no other.",
         "server, recording heartbeat-period"),
    /// A slow one reads its arm in between.
    in(kEmergencyStopped, "Four beats within 4.5 s after one.",
       [](ServerBench& server) {
         (void)server.await_beat();
         constexpr auto kTime = 4500ms;
         const auto count = server.count_beats(kTime);
         const auto least = std::min<Duration::rep>(kTime / (kBeatPeriod + server.noise()), 4);
         server.expect_true(count <= 4 && count >= static_cast<std::size_t>(least),
                            fmt::format("{} beats within 4.5 s", least < 4 ? "3 or 4" : "4"),
                            std::to_string(count));
       }),

    variant("events", in(kIdle, "Nor do events bring one.", on<expect_no_beat_with_events>)),

    must("kinovazed.beat.values",
         "Whatever happens, a heartbeat is one of 1, 3, 5, 13, 21, 37, 69 and 133.",
         "document; server; reference 7"),
    /// From one resting state to the next, by the way that the document tells.
    in(kIdle, "Eight beats on the way through four states.",
       [](ServerBench& server) {
         constexpr std::array kHealthy{1, 3, 5, 13, 21, 37, 69, 133};
         for (const auto* command : {"Retract", "EStop", "QuitEStop", "Initialize"}) {
           server.say(command);
           for (int i = 0; i < 2; ++i) {
             const auto heard = server.await_beat();
             const auto* const beat = std::get_if<Heartbeat>(&heard.message);
             const bool is_healthy =
                 beat != nullptr && std::ranges::find(kHealthy, beat->flags) != kHealthy.end();
             if (!is_healthy) server.fail_by("Heartbeat:1, 3, 5, 13, 21, 37, 69 or 133", heard);
           }
         }
       }),

    must("kinovazed.beat.decimal",
         "The number of a heartbeat is decimal, without sign and padding.", "document; server"),
    in(kEmergencyStopped, "Two beats are 3.",
       [](ServerBench& server) {
         server.expect_beat(3);
         server.expect_beat(3);
       }),

    must("kinovazed.beat.during-commands", "Commands do not hold heartbeats up.",
         "server; reference 2.1"),
    in(kEmergencyStopped, "Three beats among 36 commands come in their time.",
       [](ServerBench& server) {
         const auto first = server.await_beat();
         auto last = first;
         for (int i = 0; i < 3; ++i) {
           for (int command = 0; command < 12 && server.now() - last.time < 700ms; ++command) {
             server.accept("EStop");
             server.pause(50ms);
           }
           last = server.await_beat();
         }
         expect_time(server, last.time - first.time, 2900ms, 3300ms + server.noise());
       }),

    variant("flood", quick(in(kSteering, "Nor do moves that wait for two seconds and more.",
                              on<expect_beats_in_flood>))),

    must("kinovazed.beat.stopped", "In emergencyStopped the heartbeat is 3.",
         "document; server, recording heartbeat-values-resting"),
    in(kEmergencyStopped, "Beat 3.", on<value<kEmergencyStopped>>),

    must("kinovazed.beat.off", "In poweredOff the heartbeat is 1.",
         "document; server, recording heartbeat-values-resting"),
    in(kPoweredOff, "Beat 1.", on<value<kPoweredOff>>),

    must("kinovazed.beat.initializing",
         "While the arm initializes after an emergency stop the heartbeat is 1.",
         "document; server, state-command-matrix"),
    in(kInitializing, "Beat 1.", on<value<kInitializing>>),

    must("kinovazed.beat.initializing-again",
         "While the arm initializes again from idle the heartbeat is 5.", "server; reference 7",
         Profiles::kFirmware),
    in(kIdle, "Beat 5.", on<initialize_at_home>),

    must("kinovazed.beat.idle", "In idle the heartbeat is 21.",
         "document; server, recording heartbeat-values-resting"),
    in(kIdle, "Beat 21.", on<value<kIdle>>),

    must("kinovazed.beat.retracting", "In retracting the heartbeat is 5.",
         "document; server, state-command-matrix"),
    in(kRetracting, "Beat 5.", on<value<kRetracting>>),

    must("kinovazed.beat.retracted", "In retracted the heartbeat is 133.",
         "document; server, recording heartbeat-values-resting"),
    in(kRetracted, "Beat 133.", on<value<kRetracted>>),

    must("kinovazed.beat.unfolding", "In unfolding the heartbeat is 5.",
         "document; server, state-command-matrix"),
    in(kUnfolding, "Beat 5.", on<value<kUnfolding>>),

    must("kinovazed.beat.setting-mode", "In settingMode the heartbeat is 5.",
         "document; server, state-command-matrix"),
    in(kSettingMode, "Beat 5.", on<value<kSettingMode>>),

    must("kinovazed.beat.steering", "In steering the heartbeat is 69.",
         "document; server, recording heartbeat-values-resting"),
    in(kSteering, "Beat 69.", on<value<kSteering>>),

    must("kinovazed.beat.running", "In runningSequence the heartbeat is 37.",
         "document; server, state-command-matrix"),
    in(kRunningSequence, "Beat 37.", on<value<kRunningSequence>>),

    must("kinovazed.beat.frozen", "In frozen the heartbeat is 13.",
         "document; server, recording heartbeat-values-resting"),
    in(kFrozen, "Beat 13.", on<value<kFrozen>>),

    must("kinovazed.beat.initialized",
         "EStop clears the bit isInitialized, and only Initialized sets it again.",
         "document; server, recording heartbeat-initialised-bit"),
    in(kIdle, "Beats 21, 3, 1 and 21.",
       [](ServerBench& server) {
         server.expect_beat(21);
         server.accept("EStop");
         server.expect_beat(3);
         server.accept("QuitEStop");
         server.expect_beat(1);
         server.perform("Initialize", Event::kInitialized);
         server.expect_beat(21);
       }),

    must("kinovazed.beat.lost-arm",
         "While the arm is lost no heartbeat comes, never one without bit 0, and afterwards none "
         "that is made up for.",
         "server, recording fault-outage-idle", Profiles::kFirmware,
         "kinovazed.beat.shows-lost-arm"),
    in(kIdle, "No beat for 2.5 s, then one at a time, of 3.",
       [](ServerBench& server) {
         lose_arm(server);
         server.about("while the arm is lost");
         server.expect_no_message(2500ms);
         find_arm(server);
         server.about("once the arm is back");
         const auto beats = server.count_beats(900ms);
         server.expect_true(beats <= 1, "one beat at most within 0.9 s", std::to_string(beats));
         server.expect_beat(3);
       }),

    must("kinovazed.beat.shows-lost-arm", "While the arm is lost heartbeats go on, without bit 0.",
         "document: isConnected; our reading", Profiles::kDocumented, "kinovazed.beat.lost-arm"),
    in(kIdle, "Beat 20, later 3.",
       [](ServerBench& server) {
         lose_arm(server);
         server.expect_beat(20);
         find_arm(server);
         server.pause(1s);
         server.expect_beat(3);
       }),
};

}  // namespace

Chapter beat_chapter() { return chapter("Heartbeats", kBeatClauses); }

}  // namespace armjig::kinovazed::conformance
