// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum emulation::State;

using Recovery = ServerBench::Recovery;

void expect_lives(ServerBench& server) {
  server.pause(500ms);
  server.expect_true(server.answers(), "an answer to EStop", "silence");
}

// What kills a shipped server.

void unplug(ServerBench& server) {
  server.spoil(Recovery::kByHand);
  server.about("while the arm is unplugged");
  server.touch("arm.plugged", 0);
  server.pause(200ms);
}

void break_velocity(ServerBench& server) {
  server.spoil(Recovery::kByHand);
  server.about("behind a velocity that cannot be read");
  server.touch("arm.fail.velocity_read", 1);
  server.pause(200ms);
}

void draw_current(ServerBench& server) {
  server.spoil(Recovery::kByHand);
  server.about("behind 4.6 A");
  server.touch("arm.current", 4600);
  server.pause(200ms);
  server.touch("arm.current", 800);
}

void break_mode_write(ServerBench& server) {
  server.spoil(Recovery::kByHand);
  server.touch("arm.fail.cartesian_mode_select", 1);
  server.accept("SetJoystickMode:XYZ");
}

/// Antenna and the end of Handle are further apart than the frame allows.
void ask_position(ServerBench& server) {
  server.spoil(Recovery::kBySupervisor);
  server.perform("RunObjective:Handle", Event::kObjectiveDone);
  server.say("SetActiveObjective:Antenna");
  server.say("GetObjectivePosition");
}

void break_retract(ServerBench& server) {
  server.spoil(Recovery::kBySupervisor);
  server.touch("arm.fail.status_read", -1);
  server.say("Retract");
  server.pause(150ms);
  server.touch("arm.fail.status_read", 0);
}

void break_mode_release(ServerBench& server) {
  server.spoil(Recovery::kBySupervisor);
  server.touch("arm.fail.joystick_release", -1);
  server.say("SetJoystickMode:XYZ");
  server.pause(150ms);
  server.touch("arm.fail.joystick_release", 0);
}

void reset_waiting(ServerBench& server) {
  server.spoil(Recovery::kBySupervisor);
  server.as(1);
  server.connect();
  server.pause(100ms);
  server.throw_away();
  server.pause(100ms);
  server.as(0);
  server.leave();
  server.as(2);
  server.pause(300ms);
}

void reset_at_freeze(ServerBench& server) {
  server.spoil(Recovery::kByHand);
  server.send("Freeze\r\nUnfreeze\r\n");
  server.throw_away();
  server.as(1);
  server.pause(300ms);
  server.connect();
}

template <void (*kill)(ServerBench&)>
void hangs(ServerBench& server) {
  kill(server);
  expect_hung(server);
}

template <void (*kill)(ServerBench&)>
void ends(ServerBench& server) {
  kill(server);
  server.expect_end();
}

template <void (*kill)(ServerBench&)>
void lives(ServerBench& server) {
  kill(server);
  expect_lives(server);
}

void hang(ServerBench& server) {
  unplug(server);
  expect_hung(server);
  server.about("the next client of a hung server");
  server.connect();
  server.expect_no_message(1500ms);
}

void repairs(ServerBench& server) {
  unplug(server);
  server.touch("arm.plugged", 1);
  server.pause(300ms);
  server.expect_true(server.answers(), "an answer to EStop", "silence");
}

void ends_at_accept(ServerBench& server) {
  reset_waiting(server);
  server.expect_true(!server.is_served(), "a process that has ended", "a client that is served");
}

void lives_at_accept(ServerBench& server) {
  reset_waiting(server);
  server.expect_true(server.is_served(), "a client that is served", "none");
}

constexpr Case dies(std::string_view requirement, std::string_view rule, void (*run)(Bench&)) {
  return full(from(kReady, Hazard::kCrash, requirement, rule, run));
}

constexpr Case kCases[] = {
    dies("kinovazed.death.hang", "Neither this client nor the next hears anything.", on<hang>),
    dies("kinovazed.death.repairs", "EStop is answered.", on<repairs>),
    dies("kinovazed.death.velocity", "Nothing comes.", on<hangs<break_velocity>>),
    dies("kinovazed.death.no-velocity", "EStop is answered.", on<lives<break_velocity>>),
    dies("kinovazed.death.current", "Nothing comes.", on<hangs<draw_current>>),
    dies("kinovazed.death.no-current", "EStop is answered.", on<lives<draw_current>>),
    dies("kinovazed.death.mode-write", "Accepted, and then nothing.", on<hangs<break_mode_write>>),
    dies("kinovazed.death.no-mode-write", "EStop is answered.", on<lives<break_mode_write>>),
    dies("kinovazed.death.objective-position", "The connection ends.", on<ends<ask_position>>),
    dies("kinovazed.death.no-objective-position", "EStop is answered.", on<lives<ask_position>>),
    dies("kinovazed.death.retract-read", "The connection ends.", on<ends<break_retract>>),
    dies("kinovazed.death.no-retract-read", "EStop is answered.", on<lives<break_retract>>),
    dies("kinovazed.death.mode-release", "The connection ends.", on<ends<break_mode_release>>),
    dies("kinovazed.death.no-mode-release", "EStop is answered.", on<lives<break_mode_release>>),
    dies("kinovazed.death.accept-reset", "The next connection is refused.", on<ends_at_accept>),
    dies("kinovazed.death.no-accept-reset", "The next client is served.", on<lives_at_accept>),
    dies("kinovazed.death.mute", "The next client hears nothing.", on<hangs<reset_at_freeze>>),
    dies("kinovazed.death.no-mute", "EStop of the next client is answered.",
         on<lives<reset_at_freeze>>),
};

}  // namespace

std::span<const Case> death_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
