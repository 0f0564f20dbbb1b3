// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "emulators/kinovazed/server.hpp"
#include "harness/drive/kinovazed/client.hpp"
#include "harness/link/memory_session.hpp"

namespace armjig::kinovazed::drive {
namespace {

using namespace emulation;
using namespace std::chrono_literals;
using Kind = DriveEvent::Kind;

/// A client and an emulated server on virtual time.
struct ClientJig {
  explicit ClientJig(ServerOptions server = {}, DriveOptions drive = {})
      : port{Server{ArmPort{BenchArm{}}, std::move(server)}}, client{port, drive} {}

  /// Connected, initialised, idle.
  ClientJig& start() {
    EXPECT_TRUE(client.connect(client.now() + 2s));
    EXPECT_TRUE(ended(client.quit_estop()));
    EXPECT_TRUE(ended(client.initialize()));
    return *this;
  }
  static bool ended(const Result<CallResult>& result, Ending ending = Ending::kDone) {
    return result && *result == CallResult{.ending = ending};
  }
  void pass(Duration time) {
    for (const auto end = client.now() + time; client.now() < end;) {
      if (!client.poll(end)) return;
      for (const auto& event : client.take_events()) events.push_back(event);
    }
  }
  bool saw(Kind kind) const {
    return std::ranges::find(events, kind, &DriveEvent::kind) != events.end();
  }
  Server& server() { return port.device(); }
  State state() { return server().state(); }

  MemorySession<Server> port;
  Client client;
  std::vector<DriveEvent> events;
};

TEST(KinovaClient, ComesBackFromACallWhenTheEventHasCome) {
  ClientJig jig;
  jig.start();
  EXPECT_EQ(jig.state(), State::kIdle);
  EXPECT_TRUE(ClientJig::ended(jig.client.retract()));
  EXPECT_EQ(jig.state(), State::kRetracted);
  EXPECT_TRUE(ClientJig::ended(jig.client.unfold()));
  EXPECT_TRUE(ClientJig::ended(jig.client.freeze()));
  EXPECT_TRUE(ClientJig::ended(jig.client.unfreeze()));
  EXPECT_TRUE(ClientJig::ended(jig.client.set_joystick_mode(Mode::kXyz)));
  EXPECT_EQ(jig.state(), State::kSteering);
  EXPECT_TRUE(ClientJig::ended(jig.client.move_joystick({})));
  EXPECT_TRUE(ClientJig::ended(jig.client.run_objective(Objective::kHome)));
  EXPECT_EQ(jig.state(), State::kIdle);
  EXPECT_TRUE(ClientJig::ended(jig.client.estop()));
  EXPECT_EQ(jig.state(), State::kEmergencyStopped);
}

TEST(KinovaClient, DoesTheSameWithADocumentedServer) {
  ServerOptions options;
  options.behaviour = kDocumentedBehaviour;
  ClientJig jig{options, {.profile = Profile::kDocumented}};
  jig.start();
  EXPECT_TRUE(ClientJig::ended(jig.client.freeze()));
  EXPECT_TRUE(ClientJig::ended(jig.client.unfreeze()));
  EXPECT_TRUE(ClientJig::ended(jig.client.unfold(), Ending::kRejected));
  EXPECT_TRUE(ClientJig::ended(jig.client.run_objective(Objective::kHome)));
  EXPECT_TRUE(jig.client.take_events().empty()) << "nothing is left over";
}

TEST(KinovaClient, GetsAlongWithADocumentedServerThatItTakesForAShippedOne) {
  ServerOptions options;
  options.behaviour = kDocumentedBehaviour;
  ClientJig jig{options};
  jig.start();
  EXPECT_TRUE(ClientJig::ended(jig.client.freeze()));
}

TEST(KinovaClient, TakesReplyAndEventInBothOrders) {
  for (const auto race : {RaceOrder::kReplyFirst, RaceOrder::kEventFirst}) {
    ClientJig jig{{.race = race}};
    jig.start();
    EXPECT_TRUE(ClientJig::ended(jig.client.set_joystick_mode(Mode::kNoMode)));
    EXPECT_TRUE(ClientJig::ended(jig.client.initialize())) << "the arm is there already";
    EXPECT_TRUE(ClientJig::ended(jig.client.freeze())) << "and no reply was left over";
    EXPECT_TRUE(jig.client.take_events().empty());
  }
}

TEST(KinovaClient, SaysThatACommandWasRejected) {
  ClientJig jig;
  ASSERT_TRUE(jig.client.connect(jig.client.now() + 2s));
  EXPECT_TRUE(ClientJig::ended(jig.client.initialize(), Ending::kRejected));
}

TEST(KinovaClient, CancelsAnObjectiveWithoutAnEmergencyStop) {
  ClientJig jig;
  jig.start();
  const auto end = jig.client.now() + 300ms;
  const auto result = jig.client.run_objective(
      Objective::kHome, {.is_cancelled = [&] { return jig.client.now() >= end; }});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->kind, CallResult::Kind::kCancelled);
  jig.pass(1s);
  EXPECT_EQ(jig.state(), State::kIdle);
}

TEST(KinovaClient, CancelsAnyOtherMotionByAnEmergencyStop) {
  ClientJig jig;
  jig.start();
  const auto result = jig.client.retract({.is_cancelled = [] { return true; }});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->kind, CallResult::Kind::kCancelled);
  jig.pass(1s);
  EXPECT_EQ(jig.state(), State::kEmergencyStopped);
  EXPECT_FALSE(jig.saw(Kind::kArmStopped)) << "it was our own stop";
}

TEST(KinovaClient, GivesUpWhenTheEventTakesTooLong) {
  ClientJig jig;
  jig.start();
  const auto result = jig.client.run_objective(Objective::kHome, {.time = 100ms});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->kind, CallResult::Kind::kTimedOut);
}

TEST(KinovaClient, AnswersForACommandThatAnotherOneEnded) {
  ClientJig jig;
  jig.start();
  const auto objective =
      jig.client.begin({.verb = Verb::kRunObjective, .objective = Objective::kHome});
  ASSERT_TRUE(objective);
  jig.pass(200ms);
  EXPECT_TRUE(ClientJig::ended(jig.client.estop()));
  for (const auto& event : jig.client.take_events()) jig.events.push_back(event);
  const auto ended = std::ranges::find(jig.events, *objective, &DriveEvent::request);
  ASSERT_NE(ended, jig.events.end());
  EXPECT_EQ(ended->ending, Ending::kInterrupted);
}

TEST(KinovaClient, WaitsBetweenModesSoThatTheServerDoesNotHang) {
  ClientJig jig;
  jig.start();
  ASSERT_TRUE(jig.client.begin({.verb = Verb::kSetJoystickMode, .mode = Mode::kXyz}));
  jig.pass(60ms);
  EXPECT_TRUE(ClientJig::ended(jig.client.estop()));
  EXPECT_TRUE(ClientJig::ended(jig.client.quit_estop()));
  EXPECT_TRUE(ClientJig::ended(jig.client.initialize()));
  EXPECT_TRUE(ClientJig::ended(jig.client.set_joystick_mode(Mode::kRotation)));
  jig.pass(2s);
  EXPECT_EQ(jig.server().life(), Server::Life::kRunning);
}

TEST(KinovaClient, LetsTheStickGoWhenNobodyRenewsIt) {
  ClientJig jig;
  jig.start();
  ASSERT_TRUE(jig.client.set_joystick_mode(Mode::kXyz));
  const Command deflected{.verb = Verb::kMoveJoystick, .deflection = {100, 0, 0}};
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(ClientJig::ended(jig.client.call(deflected)));
    jig.pass(300ms);
    EXPECT_TRUE(jig.client.drive().is_stick_deflected());
  }
  jig.pass(1s);
  EXPECT_FALSE(jig.client.drive().is_stick_deflected());
  EXPECT_TRUE(jig.saw(Kind::kStickReleased));
}

TEST(KinovaClient, LetsTheStickGoBeforeItLeaves) {
  MemorySession<Server> port{Server{ArmPort{BenchArm{}}}};
  {
    Client client{port, {.stick_watchdog = 0s}};
    ASSERT_TRUE(client.connect(client.now() + 2s));
    ASSERT_TRUE(client.quit_estop());
    ASSERT_TRUE(client.initialize());
    ASSERT_TRUE(client.set_joystick_mode(Mode::kXyz));
    ASSERT_TRUE(client.move_joystick({100, 0, 0}));
  }
  const auto pose_in = [&port](Duration wait) {
    Pose pose;
    port.device().touch(port.now() + wait,
                        [&pose](ArmPort& arm) { pose = std::get<BenchArm>(arm.plant()).pose(); });
    return pose;
  };
  EXPECT_EQ(pose_in(1s), pose_in(2s));
}

TEST(KinovaClient, TellsOfAnArmThatFailed) {
  ClientJig jig;
  jig.start();
  jig.pass(1500ms);
  jig.server().touch(jig.client.now(),
                     [](ArmPort& arm) { arm.fail(ArmCall::kReadStatus, {.count = 1}); });
  jig.pass(3s);
  EXPECT_TRUE(jig.saw(Kind::kArmStopped));
  EXPECT_EQ(jig.client.drive().heartbeat()->flags, 3);
}

TEST(KinovaClient, ConnectsAnewToAServerThatFellSilent) {
  ClientJig jig;
  jig.start();
  jig.pass(1500ms);
  jig.server().touch(jig.client.now(), [](ArmPort& arm) { arm.unplug(); });
  jig.pass(10s);
  EXPECT_TRUE(jig.saw(Kind::kSilent));
  EXPECT_FALSE(jig.client.drive().heartbeat()) << "on the new connection nothing was heard yet";
  EXPECT_TRUE(jig.client.drive().is_connected());
}

TEST(KinovaClient, SaysThatADeadServerRefusesConnections) {
  ClientJig jig{{.objectives = *parse_objectives("[]", "none")}};
  jig.start();
  EXPECT_TRUE(ClientJig::ended(jig.client.run_objective(Objective::kHome), Ending::kLost));
  EXPECT_EQ(jig.client.poll(jig.client.now() + 1s).error().code, ErrorCode::kRefused);
}

}  // namespace
}  // namespace armjig::kinovazed::drive
