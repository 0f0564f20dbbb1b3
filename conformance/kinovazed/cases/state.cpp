// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using namespace std::string_view_literals;
using enum emulation::State;

/// EStop comes in any state, and what it ended is not told.
template <emulation::State state>
void estop(ServerBench& server) {
  enter(server, state);
  server.accept("EStop");
  server.expect_beat(3);
}

/// All of them, one after the other.
void refuse_all(ServerBench& server, std::span<const std::string_view> commands) {
  for (const auto command : commands) server.refuse(command);
}

constexpr std::array kAllButEStop{"QuitEStop"sv,
                                  "Initialize"sv,
                                  "Unfold"sv,
                                  "Retract"sv,
                                  "Freeze"sv,
                                  "Unfreeze"sv,
                                  "SetJoystickMode:Rotation"sv,
                                  "MoveJoystick:0:0:0"sv,
                                  "RunObjective:Home"sv};

/// The others of them, in their order.
template <class... LeftOut>
constexpr auto all_but(LeftOut... left_out) {
  std::array<std::string_view, kAllButEStop.size() - sizeof...(left_out)> others;
  std::ranges::copy_if(kAllButEStop, others.begin(),
                       [&](std::string_view one) { return ((one != left_out) && ...); });
  return others;
}

constexpr auto kAllButStops = all_but("QuitEStop"sv);
constexpr auto kAllButInitialize = all_but("QuitEStop"sv, "Initialize"sv);
constexpr std::array kNotInIdle{"Unfold"sv, "Unfreeze"sv, "MoveJoystick:0:0:0"sv, "QuitEStop"sv};
constexpr auto kNotInRetracted = all_but("Unfold"sv, "Retract"sv);
constexpr auto kNotInSettingMode = all_but("Retract"sv);
constexpr std::array kNotInSteering{"Initialize"sv, "Unfold"sv, "Retract"sv, "Unfreeze"sv,
                                    "QuitEStop"sv};
constexpr auto kNotInRunning = all_but("SetJoystickMode:Rotation"sv, "RunObjective:Home"sv);
constexpr auto kNotInFrozen = all_but("Freeze"sv, "Unfreeze"sv);

template <emulation::State state, const auto& commands>
void refused(ServerBench& server) {
  enter(server, state);
  refuse_all(server, commands);
  server.expect_beat(beat_of(state));
}

/// Of states that end by themselves.
template <emulation::State state, const auto& commands, Event event>
void refused_until(ServerBench& server) {
  enter(server, state);
  refuse_all(server, commands);
  server.about(std::string{to_string(event)} + " behind refused commands");
  server.expect(event, ServerBench::kMotionTime);
}

void start(ServerBench& server) { server.expect_beat(3); }

void table(ServerBench& server) {
  for (const auto mode : kModeNames) server.refuse("SetJoystickMode:" + std::string{mode});
  for (const auto objective : kObjectiveNames) {
    server.refuse("RunObjective:" + std::string{objective});
  }
  server.expect_beat(3);
}

void stopped_estop(ServerBench& server) {
  server.accept("EStop");
  server.expect_beat(3);
}

void stopped_quit(ServerBench& server) {
  server.accept("QuitEStop");
  server.expect_beat(1);
}

void off_quit(ServerBench& server) {
  server.accept("QuitEStop");
  server.expect_beat(1);
}

/// The arm may be there already.
void initialize(ServerBench& server) {
  server.perform("Initialize", Event::kInitialized);
  server.expect_beat(21);
}

void freeze(ServerBench& server) {
  server.perform("Freeze", Event::kFreezed);
  server.expect_beat(13);
}

void unfreeze(ServerBench& server) {
  enter(server, kFrozen);
  server.perform("Unfreeze", Event::kUnfreezed);
  server.expect_beat(21);
}

/// What takes its time: a beat on the way, and the event behind it.
void on_the_way(ServerBench& server, std::string_view command, int flags, Event event) {
  server.wait_until_before_beat(kBeforeBeat);
  server.accept(command);
  server.expect_beat(flags);
  server.expect(event, ServerBench::kMotionTime);
}

void retract(ServerBench& server) { on_the_way(server, "Retract", 5, Event::kRetracted); }
void unfold(ServerBench& server) { on_the_way(server, "Unfold", 5, Event::kUnfolded); }
void objective(ServerBench& server) {
  on_the_way(server, kFarObjective, 37, Event::kObjectiveDone);
}
void mode(ServerBench& server) {
  on_the_way(server, "SetJoystickMode:Rotation", 5, Event::kJoystickModeSet);
}

void setting_mode_retract(ServerBench& server) {
  server.accept("SetJoystickMode:XYZ");
  server.accept("Retract");
  server.expect_beat(5);
  server.expect(Event::kRetracted, ServerBench::kMotionTime);
}

void steering_move(ServerBench& server) {
  for (const auto* move : {"MoveJoystick:4:0:0", "MoveJoystick:0:-4:4", "MoveJoystick:0:0:0"}) {
    server.accept(move);
  }
  server.expect_beat(69);
}

void running_mode(ServerBench& server) {
  server.wait_until_before_beat(kBeforeBeat + 60ms);
  server.accept(kFarObjective);
  server.accept("SetJoystickMode:Rotation");
  server.expect_beat(5);
  server.expect(Event::kJoystickModeSet);
}

void running_objective(ServerBench& server) {
  server.wait_until_before_beat(2 * kBeforeBeat);
  server.accept("RunObjective:Home");
  server.accept(kFarObjective);
  server.expect_beat(37);
  server.expect(Event::kObjectiveDone, ServerBench::kMotionTime);
}

constexpr Case kCases[] = {
    // First, for without EStop no other case can begin.
    in(kEmergencyStopped, "kinovazed.state.stopped.estop", "Accepted, and beat 3.",
       on<stopped_estop>),
    in(kPoweredOff, "kinovazed.state.off.estop", "Accepted, and beat 3.", on<estop<kPoweredOff>>),
    in(kInitializing, "kinovazed.state.initializing.estop", "Accepted, and beat 3.",
       on<estop<kInitializing>>),
    quick(in(kIdle, "kinovazed.state.idle.estop", "Accepted, and beat 3.", on<estop<kIdle>>)),
    in(kRetracting, "kinovazed.state.retracting.estop", "Accepted, and beat 3.",
       on<estop<kRetracting>>),
    in(kRetracted, "kinovazed.state.retracted.estop", "Accepted, and beat 3.",
       on<estop<kRetracted>>),
    in(kUnfolding, "kinovazed.state.unfolding.estop", "Accepted, and beat 3.",
       on<estop<kUnfolding>>),
    in(kSettingMode, "kinovazed.state.setting-mode.estop", "Accepted, and beat 3.",
       on<estop<kSettingMode>>),
    quick(in(kSteering, "kinovazed.state.steering.estop", "Accepted, and beat 3.",
             on<estop<kSteering>>)),
    quick(in(kRunningSequence, "kinovazed.state.running.estop", "Accepted, and beat 3.",
             on<estop<kRunningSequence>>)),
    quick(in(kFrozen, "kinovazed.state.frozen.estop", "Accepted, and beat 3.", on<estop<kFrozen>>)),

    from(kFresh, Hazard::kObserve, "kinovazed.state.start",
         "The first beat of a fresh server says emergencyStopped.", on<start>),
    in(kEmergencyStopped, "kinovazed.state.table",
       "All modes and objectives are Rejected in emergencyStopped.", on<table>),

    from(kStopped, Hazard::kState, "kinovazed.state.stopped.quit-estop", "Accepted, and beat 1.",
         on<stopped_quit>),
    in(kEmergencyStopped, "kinovazed.state.stopped.refused", "Eight commands, and beat 3.",
       on<refused<kEmergencyStopped, kAllButStops>>),

    in(kPoweredOff, "kinovazed.state.off.quit-estop", "Accepted, and beat 1.", on<off_quit>),
    from(kOff, Hazard::kMove, "kinovazed.state.off.initialize", "Initialized, and beat 21.",
         on<initialize>),
    in(kPoweredOff, "kinovazed.state.off.refused", "Seven commands, and beat 1.",
       on<refused<kPoweredOff, kAllButInitialize>>),

    quick(in(kInitializing, "kinovazed.state.initializing.refused",
             "Nine commands, then Initialized.",
             on<refused_until<kInitializing, kAllButEStop, Event::kInitialized>>)),

    in(kIdle, "kinovazed.state.idle.initialize", "Initialized, and beat 21.", on<initialize>),
    in(kIdle, "kinovazed.state.idle.retract", "Beat 5, then Retracted.", on<retract>),
    quick(in(kIdle, "kinovazed.state.idle.freeze", "Freezed, and beat 13.", on<freeze>)),
    in(kIdle, "kinovazed.state.idle.mode", "Beat 5, then JoystickModeSet.", on<mode>),
    in(kIdle, "kinovazed.state.idle.objective", "Beat 37, then ObjectiveDone.", on<objective>),
    quick(in(kIdle, "kinovazed.state.idle.refused", "Four commands, and beat 21.",
             on<refused<kIdle, kNotInIdle>>)),

    quick(in(kRetracting, "kinovazed.state.retracting.refused", "Nine commands, then Retracted.",
             on<refused_until<kRetracting, kAllButEStop, Event::kRetracted>>)),

    quick(in(kRetracted, "kinovazed.state.retracted.unfold", "Beat 5, then Unfolded.", on<unfold>)),
    quick(in(kRetracted, "kinovazed.state.retracted.refused", "Seven commands, and beat 133.",
             on<refused<kRetracted, kNotInRetracted>>)),

    quick(in(kUnfolding, "kinovazed.state.unfolding.refused", "Nine commands, then Unfolded.",
             on<refused_until<kUnfolding, kAllButEStop, Event::kUnfolded>>)),

    in(kSettingMode, "kinovazed.state.setting-mode.retract", "Beat 5, then Retracted.",
       on<setting_mode_retract>),
    quick(in(kSettingMode, "kinovazed.state.setting-mode.refused",
             "Eight commands, then JoystickModeSet.",
             on<refused_until<kSettingMode, kNotInSettingMode, Event::kJoystickModeSet>>)),

    quick(in(kSteering, "kinovazed.state.steering.freeze", "Freezed, and beat 13.", on<freeze>)),
    quick(
        in(kSteering, "kinovazed.state.steering.mode", "Beat 5, then JoystickModeSet.", on<mode>)),
    quick(in(kSteering, "kinovazed.state.steering.move", "Three moves are Accepted, and beat 69.",
             on<steering_move>)),
    in(kSteering, "kinovazed.state.steering.objective", "Beat 37, then ObjectiveDone.",
       on<objective>),
    quick(in(kSteering, "kinovazed.state.steering.refused", "Five commands, and beat 69.",
             on<refused<kSteering, kNotInSteering>>)),

    in(kRunningSequence, "kinovazed.state.running.mode", "Beat 5, then JoystickModeSet.",
       on<running_mode>),
    in(kRunningSequence, "kinovazed.state.running.objective", "Beat 37, then ObjectiveDone.",
       on<running_objective>),
    quick(in(kRunningSequence, "kinovazed.state.running.refused",
             "Seven commands, then ObjectiveDone.",
             on<refused_until<kRunningSequence, kNotInRunning, Event::kObjectiveDone>>)),

    quick(in(kFrozen, "kinovazed.state.frozen.unfreeze", "Unfreezed, and beat 21.", on<unfreeze>)),
    quick(in(kFrozen, "kinovazed.state.frozen.refused", "Seven commands, and beat 13.",
             on<refused<kFrozen, kNotInFrozen>>)),
};

}  // namespace

std::span<const Case> state_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
