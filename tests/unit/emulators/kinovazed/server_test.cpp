// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/server.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/unit/emulators/kinovazed/bench.hpp"

namespace armjig::kinovazed::emulation {
namespace {

using namespace std::chrono_literals;
using test::Bench;
using test::documented;

constexpr auto kAccepted = "Accepted\r\n";

// Clients.

TEST(KinovaServer, LetsASecondClientWait) {
  Bench bench;
  const auto second = bench.connect();
  bench.send(second, "EStop\r\n");
  bench.pass(1600ms);
  EXPECT_EQ(bench.heard(second), "");
  bench.server.close(bench.now, bench.client);
  bench.pass(50ms);
  EXPECT_EQ(bench.heard(second), kAccepted);
}

TEST(KinovaServer, ServesAWaitingClientThatHasClosedAndDiesOfOneThatHasReset) {
  Bench bench;
  const auto second = bench.connect();
  bench.send(second, "QuitEStop\r\n");
  bench.server.close(bench.now, second);
  bench.server.close(bench.now, bench.client);
  bench.pass(50ms);
  EXPECT_EQ(bench.server.state(), State::kPoweredOff);
  bench.client = bench.connect();
  bench.pass(1ms);
  const auto third = bench.connect();
  bench.server.reset(bench.now, third);
  bench.server.close(bench.now, bench.client);
  bench.pass(50ms);
  EXPECT_EQ(bench.server.life(), Server::Life::kEnded);
  EXPECT_FALSE(bench.server.connect(bench.now));
}

TEST(KinovaServer, DiesOfTheThirdInstantResetIfToldTo) {
  ServerOptions options;
  options.behaviour.dies_of_resets = true;
  Bench bench{options};
  bench.server.close(bench.now, bench.client);
  const auto come_and_reset = [&](std::string_view text) {
    const auto id = bench.connect();
    bench.pass(1ms);
    bench.send(id, text);
    bench.pass(20ms);
    bench.server.reset(bench.now, id);
    bench.pass(5ms);
  };
  come_and_reset("");
  for (int i = 0; i < 5; ++i) come_and_reset("EStop\r\n");  // they hear Accepted
  come_and_reset("ESt");
  EXPECT_EQ(bench.server.life(), Server::Life::kRunning);
  come_and_reset("");
  EXPECT_EQ(bench.server.life(), Server::Life::kEnded);
  Bench shipped;
  for (int i = 0; i < 50; ++i) {
    shipped.server.reset(shipped.now, shipped.client);
    shipped.pass(5ms);
    shipped.client = shipped.connect();
    shipped.pass(5ms);
  }
  EXPECT_EQ(shipped.server.life(), Server::Life::kRunning) << "not by itself";
}

struct CloseCase {
  const char* name;
  const char* lines;
  void (Server::*leave)(Instant, ConnectionId);
  std::string_view heard;
  bool is_mute;
};

TEST(KinovaServer, GoesMuteIfTwoMessagesWaitWhenAWriteFails) {
  const std::vector<CloseCase> cases{
      {"one pair, reset", "Freeze\r\n", &Server::reset, "", true},
      {"one pair, closed", "Freeze\r\n", &Server::close, "", false},
      {"two pairs, closed", "Freeze\r\nUnfreeze\r\n", &Server::close, "", true},
      {"one pair, half-closed", "Freeze\r\n", &Server::half_close, "Accepted\r\n<end>", false},
      {"two pairs, half-closed", "Freeze\r\nUnfreeze\r\n", &Server::half_close,
       "Accepted\r\nFreezed\r\n<end>", true},
      {"single messages, closed", "MoveJoystick:1:1:1\r\nQuitEStop\r\nRetract\r\n", &Server::close,
       "", false},
  };
  for (const auto& one : cases) {
    Bench bench;
    bench.to_idle();
    bench.send(one.lines);
    (bench.server.*one.leave)(bench.now, bench.client);
    bench.pass(200ms);
    const auto heard = bench.heard(bench.client);
    EXPECT_EQ(heard, one.heard) << one.name;
    bench.client = bench.connect();
    EXPECT_EQ(bench.ask("EStop\r\n"), one.is_mute ? "" : kAccepted) << one.name;
    EXPECT_EQ(bench.server.state(), State::kEmergencyStopped) << one.name;
  }
}

TEST(KinovaServer, GoesMuteOfFiveLinesOfAClientThatWaitedAndHasClosed) {
  // The first write is taken, two fail at once, and after the fourth the fifth message waits. So
  // does a small server on the event loop of the original.
  for (const auto count : {4, 5, 6, 25}) {
    Bench bench;
    bench.to_idle();
    const auto second = bench.connect();
    for (int i = 0; i < count; ++i) bench.send(second, "Unfold\r\n");
    bench.server.close(bench.now, second);
    bench.server.close(bench.now, bench.client);
    bench.pass(200ms);
    bench.client = bench.connect();
    EXPECT_EQ(bench.ask("EStop\r\n"), count < 5 ? kAccepted : "") << count;
  }
}

TEST(KinovaServer, StopsNothingWhenItsClientLeaves) {
  Bench bench;
  bench.to_idle().go({"SetJoystickMode:XYZ", "MoveJoystick:0:0:40"});
  const auto before = std::get<BenchArm>(bench.server.arm().plant()).pose().z;
  bench.server.close(bench.now, bench.client);
  bench.pass(2s);
  EXPECT_GT(std::get<BenchArm>(bench.server.arm().plant()).pose().z, before + 0.02F);
  bench.client = bench.connect();
  EXPECT_EQ(bench.beat(), "69");
  EXPECT_EQ(bench.ask("MoveJoystick:0:0:0\r\n"), kAccepted);
}

TEST(KinovaServer, EndsWithAFinOnSigterm) {
  Bench bench;
  bench.server.terminate(bench.now);
  EXPECT_EQ(bench.heard(bench.client), "<end>");
  EXPECT_FALSE(bench.server.connect(bench.now));
}

// Deaths.

struct DeathCase {
  const char* name;
  std::vector<std::string_view> lines;  ///< from idle
  void (*hurt)(ArmPort&);
  const char* last;
  Server::Life life;
};

TEST(KinovaServer, HangsOrDiesAsTheOriginal) {
  const std::vector<DeathCase> cases{
      {"velocity",
       {},
       [](ArmPort& arm) { arm.fail(ArmCall::kReadVelocity, {0, 1}); },
       "",
       Server::Life::kHung},
      {"current",
       {},
       [](ArmPort& arm) { std::get<BenchArm>(arm.plant()).set_current_sum(4.6F); },
       "",
       Server::Life::kHung},
      {"unplugged", {}, [](ArmPort& arm) { arm.unplug(); }, "", Server::Life::kHung},
      {"mode write",
       {},
       [](ArmPort& arm) { arm.fail(ArmCall::kSelectCartesian, {0, 1}); },
       "SetJoystickMode:XYZ\r\n",
       Server::Life::kHung},
      {"mode release",
       {},
       [](ArmPort& arm) { arm.fail(ArmCall::kReleaseStick, {1, 1}); },
       "SetJoystickMode:XYZ\r\n",
       Server::Life::kEnded},
      {"current 4.4",
       {},
       [](ArmPort& arm) { std::get<BenchArm>(arm.plant()).set_current_sum(4.4F); },
       "",
       Server::Life::kRunning},
      {"mode too soon",
       {"SetJoystickMode:XYZ"},
       [](ArmPort&) {},
       "SetJoystickMode:XYZ\r\nEStop\r\nQuitEStop\r\nInitialize\r\nSetJoystickMode:Rotation\r\n",
       Server::Life::kHung},
      {"no mode too soon",
       {"SetJoystickMode:XYZ"},
       [](ArmPort&) {},
       "SetJoystickMode:XYZ\r\nEStop\r\nQuitEStop\r\nInitialize\r\nSetJoystickMode:NoMode\r\n",
       Server::Life::kRunning},
  };
  for (const auto& one : cases) {
    Bench bench;
    bench.to_idle();
    for (const auto line : one.lines) bench.go({line});
    bench.server.touch(bench.now, one.hurt);
    bench.send(one.last);
    bench.pass(300ms);
    EXPECT_EQ(bench.server.life(), one.life) << one.name;
    if (one.life != Server::Life::kHung) continue;
    bench.server.clear_sent();
    bench.pass(1500ms);
    EXPECT_EQ(bench.ask("EStop\r\n"), "") << one.name;
    bench.server.terminate(bench.now);
    EXPECT_EQ(bench.server.life(), Server::Life::kHung) << "SIGTERM is ignored: " << one.name;
  }
}

TEST(KinovaServer, TellsNoEndIfTheButtonCannotBeLetGo) {
  // The release comes before the event and belongs to the reading of the mode, whose failure is
  // repaired in silence.
  struct Case {
    ArmMode start;
    std::vector<std::string_view> lines;
    std::string_view last;
    int releases;  ///< that work before the one at the end
  };
  const std::vector<Case> cases{
      {ArmMode::kNeverHomed, {"QuitEStop"}, "Initialize\r\n", 0},
      {ArmMode::kReady, {"QuitEStop", "Initialize"}, "Retract\r\n", 0},
      {ArmMode::kReady,
       {"QuitEStop", "Initialize", "SetJoystickMode:XYZ", "MoveJoystick:9:0:0",
        "SetJoystickMode:NoMode"},
       "Retract\r\n",
       0},
      {ArmMode::kReady, {"QuitEStop", "Initialize", "Retract", "", "", ""}, "Unfold\r\n", 0},
  };
  for (const auto& one : cases) {
    Bench bench{{}, {.start_mode = one.start}};
    bench.go({});
    for (const auto line : one.lines) bench.go({line});
    bench.server.touch(bench.now,
                       [&](ArmPort& arm) { arm.fail(ArmCall::kReleaseStick, {one.releases, 1}); });
    bench.send(one.last);
    bench.pass(5s);
    EXPECT_EQ(bench.heard(bench.client), kAccepted) << one.last;
    EXPECT_EQ(bench.beat(), "3") << one.last;
  }
}

/// How long after an EStop in idle, whose `call` fails, its reply comes.
Duration reply_to_estop(ArmCall call, std::uint32_t late_repairs) {
  Bench bench{{.late_repairs = late_repairs}};
  bench.to_idle();
  bench.server.touch(bench.now, [&](ArmPort& arm) { arm.fail(call, {0, 1}); });
  bench.send("EStop\r\n");
  const auto asked = bench.now;
  while (bench.server.sent().empty() && bench.now < asked + 500ms) bench.pass(1ms);
  EXPECT_EQ(bench.heard(bench.client), kAccepted);
  EXPECT_EQ(bench.server.repair_races(), call == ArmCall::kReleaseControl ? 0U : 1U);
  bench.pass(500ms);
  EXPECT_EQ(bench.beat(), "3");
  return bench.now - asked - 1600ms;
}

TEST(KinovaServer, RepairsTheArmInTheMiddleOfAnEStop) {
  // A stop is erase, axes and release with 10 ms after each that works, a call takes 0.6 ms:
  // 31.8 ms; the repair has 50 ms of opening, two looks of 2.4 ms, taking control, and a stop.
  for (const auto call : {ArmCall::kErase, ArmCall::kReleaseStick}) {
    const auto reply = reply_to_estop(call, 0);
    EXPECT_GE(reply, 108ms);
    EXPECT_LE(reply, 114ms);
  }
  // Axes that fail leave out the release.
  EXPECT_NEAR(std::chrono::duration<double>{reply_to_estop(ArmCall::kWriteAxes, 0)}.count(), 0.101,
              0.003);
  EXPECT_LE(reply_to_estop(ArmCall::kReleaseControl, 0), 38ms) << "nothing is left to wait for";
  // Recording defect-neighbour-release-on-estop: 23 ms, the other order.
  EXPECT_LE(reply_to_estop(ArmCall::kReleaseStick, 1), 26ms);
}

TEST(KinovaServer, HangsOnALaterPointOutsideAndDiesOfAMissingObjective) {
  ServerOptions options;
  options.objectives = ObjectiveSet{
      {{Objective::kHome, Pose{}, {{0.2F, -0.2F, 0.5F, 1.6F, 1.1F, 0.1F}, {.x = 0.9F}}}}};
  Bench bench{options};
  bench.to_idle();
  EXPECT_EQ(bench.ask("RunObjective:Home\r\n"), kAccepted);
  bench.pass(5s);
  EXPECT_EQ(bench.server.life(), Server::Life::kHung);
  Bench other{options};
  EXPECT_EQ(other.ask("RunObjective:Handle\r\n"), "<end>");
  EXPECT_EQ(other.server.life(), Server::Life::kEnded);
}

TEST(KinovaServer, ComesBackTwoSecondsAfterItsDeathIfToldTo) {
  ServerOptions options;
  options.objectives = {};
  options.on_death = OnDeath::kRestart;
  Bench bench{options};
  bench.go({"QuitEStop"});
  EXPECT_EQ(bench.ask("RunObjective:Home\r\n"), "<end>");
  EXPECT_FALSE(bench.server.connect(bench.now));
  bench.pass(2s);
  bench.client = bench.connect();
  EXPECT_EQ(bench.beat(), "3");
  EXPECT_EQ(bench.ask("QuitEStop\r\n"), kAccepted);
}

TEST(KinovaServer, DoesNotListenBeforeItHasFoundItsArm) {
  ArmPort arm{BenchArm{}};
  arm.unplug();
  Server server{std::move(arm)};
  EXPECT_FALSE(server.connect(at(3s)));
  server.touch(at(3s), [](ArmPort& port) { port.plug(); });
  EXPECT_TRUE(server.connect(at(4300ms)));
}

// Objectives and the console.

TEST(KinovaServer, LogsPosesAsTheHowToWantsThem) {
  Bench bench;
  bench.to_idle();
  EXPECT_EQ(bench.ask("GetObjectivePosition\r\nSetActiveObjective:Handle\r\nGetAbsolutePosition\r\n"
                      "GetObjectivePosition\r\n"),
            "");
  ASSERT_EQ(bench.server.log().size(), 3U);
  EXPECT_EQ(bench.server.log()[0].text, "no current objective");
  EXPECT_TRUE(bench.server.log()[1].text.starts_with("Current arm position (abs): { \"X\":  "));
  const auto& text = bench.server.log()[2].text;
  EXPECT_TRUE(text.starts_with("Current arm position (obj): "));
  const auto pose = nlohmann::json::parse(text.substr(text.find('{')));
  EXPECT_EQ(pose.size(), 6U);
}

TEST(KinovaServer, NeverArrivesWithAnArmThatStandsPerfectlyStill) {
  Bench still{{}, {.start_mode = ArmMode::kReady, .position_noise = 0}};
  still.to_idle();
  EXPECT_EQ(still.ask("RunObjective:Current\r\n"), kAccepted);
  EXPECT_EQ(still.beat(), "37");
  Bench real;
  real.to_idle();
  EXPECT_EQ(real.ask("RunObjective:Current\r\n"), "Accepted\r\nObjectiveDone\r\n");
}

TEST(KinovaServer, StaysStuckIfInitializationEndsFolded) {
  Bench bench{{}, {}};
  bench.go({"QuitEStop", "Initialize"});
  bench.server.touch(
      bench.now, [](ArmPort& arm) { std::get<BenchArm>(arm.plant()).set_mode(ArmMode::kFolded); });
  bench.pass(50ms);
  EXPECT_EQ(bench.heard(bench.client), "Retracted\r\n");
  EXPECT_EQ(bench.ask("Unfold\r\nRetract\r\n"), "Rejected\r\nRejected\r\n");
  EXPECT_EQ(bench.server.state(), State::kInitializing);
}

TEST(KinovaServer, RetractsFromAnywhereByWayOfReady) {
  Bench bench;
  bench.to_idle();
  bench.server.touch(bench.now, [](ArmPort& arm) {
    std::get<BenchArm>(arm.plant()).set_mode(ArmMode::kElsewhere);
  });
  bench.pass(50ms);
  EXPECT_EQ(bench.ask("Retract\r\n"), kAccepted);
  bench.pass(2500ms);
  EXPECT_EQ(bench.heard(bench.client), "");
  bench.pass(500ms);
  EXPECT_EQ(bench.heard(bench.client), "Retracted\r\n");
  EXPECT_EQ(bench.beat(), "133");
}

TEST(KinovaServer, BoundsTheJoystickAtTheEdge) {
  Bench bench;
  bench.to_idle().go({"SetJoystickMode:XYZ"});
  const auto x = [&] { return std::get<BenchArm>(bench.server.arm().plant()).pose().x; };
  bench.server.touch(bench.now, [](ArmPort& arm) {
    std::get<BenchArm>(arm.plant()).set_pose({.x = 0.7905F, .z = 0.5F});
  });
  bench.pass(50ms);
  EXPECT_EQ(bench.ask("MoveJoystick:-100:0:0\r\n"), kAccepted);
  EXPECT_GT(x(), 0.7899F);
  EXPECT_EQ(bench.ask("MoveJoystick:100:0:0\r\n"), kAccepted);
  bench.server.touch(bench.now, [](ArmPort& arm) {
    std::get<BenchArm>(arm.plant()).set_pose({.x = 0.5F, .z = 0.5F});
  });
  EXPECT_EQ(bench.ask("MoveJoystick:-100:0:0\r\n"), kAccepted);
  EXPECT_LT(x(), 0.5F);
}

// The document's server.

TEST(KinovaDocumented, AnswersWithTheOneEventOfACommand) {
  Bench bench{documented(), {.start_mode = ArmMode::kReady}};
  EXPECT_EQ(bench.ask("EStop\r\nQuitEStop\r\nInitialize\r\n"),
            "Accepted\r\nAccepted\r\nInitialized\r\n");
  EXPECT_EQ(bench.ask("Freeze\r\n"), "Freezed\r\n");
  EXPECT_EQ(bench.ask("Freeze\r\n"), "Freezed\r\n");
  EXPECT_EQ(bench.ask("Unfreeze\r\n"), "Unfreezed\r\n");
  EXPECT_EQ(bench.ask("Unfreeze\r\n"), "Unfreezed\r\n");
  EXPECT_EQ(bench.ask("RunObjective:Current\r\n"), "ObjectiveDone\r\n");
  EXPECT_EQ(bench.ask("Unfreeze\r\n"), "Rejected\r\n");
  EXPECT_EQ(bench.ask("MoveJoystick:1:2:3\r\n"), "Rejected\r\n");
}

TEST(KinovaDocumented, RejectsWhatIsNoCommand) {
  Bench bench{documented()};
  EXPECT_EQ(bench.ask("Foo\r\n\nEStop\r\n estop\r\nRunObjective:FindBottle\r\n"),
            "Rejected\r\nAccepted\r\nRejected\r\nRejected\r\n");
  EXPECT_EQ(bench.ask(std::string(1025, 'B')), "<end>");
}

TEST(KinovaDocumented, ShowsALostArmInItsBeats) {
  Bench bench{documented()};
  bench.to_idle();
  bench.server.touch(bench.now, [](ArmPort& arm) { arm.unplug(); });
  EXPECT_EQ(bench.beat(), "20");
  bench.server.touch(bench.now, [](ArmPort& arm) { arm.plug(); });
  EXPECT_EQ(bench.beat(), "3");
}

TEST(KinovaDocumented, SurvivesWhatKillsTheOriginal) {
  for (const auto call : {ArmCall::kReadVelocity, ArmCall::kSelectCartesian}) {
    Bench bench{documented()};
    bench.to_idle();
    bench.server.touch(bench.now, [&](ArmPort& arm) { arm.fail(call, {0, 1}); });
    bench.ask("SetJoystickMode:XYZ\r\n");
    EXPECT_EQ(bench.beat(), "3");
    EXPECT_EQ(bench.ask("QuitEStop\r\n"), kAccepted);
  }
}

// A value.

TEST(KinovaServer, GoesOnInACopyAsInTheOriginal) {
  Bench bench{{}, {}};
  bench.go({"QuitEStop"});
  bench.send("Initialize\r\nESt");
  bench.pass(5ms);
  auto copy = bench;
  for (auto* one : {&bench, &copy}) {
    one->pass(3s);
    one->send("op\r\n");
    one->pass(100ms);
  }
  ASSERT_EQ(bench.server.sent().size(), copy.server.sent().size());
  for (std::size_t i = 0; i < bench.server.sent().size(); ++i) {
    EXPECT_EQ(bench.server.sent()[i].bytes, copy.server.sent()[i].bytes);
    EXPECT_EQ(bench.server.sent()[i].time, copy.server.sent()[i].time);
  }
}

TEST(KinovaServer, CanPutTheEventBeforeItsReply) {
  ServerOptions options;
  options.race = RaceOrder::kEventFirst;
  Bench bench{options};
  bench.go({"QuitEStop"});
  EXPECT_EQ(bench.ask("Initialize\r\n"), "Initialized\r\nAccepted\r\n");
}

}  // namespace
}  // namespace armjig::kinovazed::emulation
