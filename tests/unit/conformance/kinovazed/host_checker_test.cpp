// SPDX-License-Identifier: Apache-2.0
// For each requirement of a client a program that breaks just that one; and programs that are good.
#include "conformance/kinovazed/host/check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/program_check.hpp"
#include "emulators/kinovazed/options.hpp"
#include "emulators/memory/in_memory.hpp"
#include "harness/capture/trace.hpp"
#include "harness/drive/kinovazed/client.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig::kinovazed::programs {
namespace {

using namespace drive;
using namespace std::chrono_literals;

ProgramCheckEntry entry() { return program_check(); }

/// A server whose clients are judged, in virtual time.
class Session {
 public:
  explicit Session(DeviceOptions options = {}) {
    options.try_emplace("plant", "bench");
    server_ = open_in_memory(check_.watch(make_hosted(*emulation::make(options, "test"))));
    port_ = make_port();
  }

  /// Another client.
  [[nodiscard]] std::unique_ptr<SessionPort> make_port() { return server_->make_port(); }
  [[nodiscard]] SessionPort& port() { return *port_; }

  Session& connect() {
    EXPECT_TRUE(port_->connect(port_->now()));
    return *this;
  }
  Session& wait(Duration duration) {
    server_->pause(duration);
    return *this;
  }
  /// Connected, and a heartbeat came.
  Session& look() { return connect().wait(1100ms); }
  Session& write(std::string_view bytes) {
    EXPECT_TRUE(port_->send(std::as_bytes(std::span{bytes})));
    return *this;
  }
  /// A line, and the time that its answer needs.
  Session& say(std::string_view line, Duration pause = 110ms) {
    return write(std::string{line} + "\r\n").wait(pause);
  }
  /// An arm at its ready pose.
  Session& start() { return look().say("QuitEStop").say("Initialize", 6s); }
  Session& steer(std::string_view mode = "XYZ") {
    return start().say("SetJoystickMode:" + std::string{mode}, 800ms);
  }
  void leave() { port_->close(); }
  bool touch(std::string_view input, std::int64_t value) { return server_->touch(input, value); }

  /// Ids of what was broken; ends the session.
  std::set<std::string> broken() { return rows_with(Verdict::kFail); }
  /// The same of another verdict.
  std::set<std::string> rows_with(Verdict verdict) {
    std::set<std::string> ids;
    for (const auto& row : check_.finish().rows) {
      if (row.verdict == verdict) ids.insert(row.requirement);
    }
    return ids;
  }
  /// What was said of that requirement first.
  std::string said_of(std::string_view requirement) const {
    const auto found = std::ranges::find(offences_, requirement, &Offence::requirement);
    return found == offences_.end() ? "" : found->what;
  }

 private:
  std::vector<Offence> offences_;
  ProgramCheck check_{
      entry(), {}, [this](const Offence& offence) { offences_.push_back(offence); }};
  std::unique_ptr<SessionSource> server_;
  std::unique_ptr<SessionPort> port_;
};

struct WrongClient {
  const char* requirement;
  std::function<void(Session&)> run;
  DeviceOptions options{};
};
void PrintTo(const WrongClient& wrong, std::ostream* out) { *out << wrong.requirement; }

/// One bad line behind a good one.
auto bad_line(std::string line) {
  return [line = std::move(line)](Session& client) { client.look().say("EStop").say(line); };
}
auto bad_bytes(std::string bytes) {
  return [bytes = std::move(bytes)](Session& client) {
    client.look().say("EStop").write(bytes).wait(110ms).say("EStop");
  };
}
auto bad_while_steering(std::string line) {
  return [line = std::move(line)](Session& client) {
    client.steer().say(line).say("MoveJoystick:0:0:0");
  };
}

std::vector<WrongClient> wrong_clients() {
  using namespace std::string_literals;
  return {
      {"kinovazed.host.line-end", bad_bytes("EStop\n")},
      {"kinovazed.host.line-empty", bad_bytes("\n")},
      {"kinovazed.host.line-length", bad_bytes("EStop" + std::string(125, ' ') + "\r\n")},
      {"kinovazed.host.line-finished",
       [](Session& client) { client.look().say("EStop").write("Quit").leave(); }},
      {"kinovazed.host.line-ascii", bad_bytes("EStop\0\r\n"s)},
      {"kinovazed.host.bare-line", bad_line("EStop :")},
      {"kinovazed.host.known-words", bad_line("Stop")},
      {"kinovazed.host.word-case", bad_line("estop")},
      {"kinovazed.host.argument-count", bad_line("EStop:1")},
      {"kinovazed.host.mode-name", bad_while_steering("SetJoystickMode:Axis1")},
      {"kinovazed.host.objective-name", bad_while_steering("RunObjective:Bell")},
      {"kinovazed.host.objective-documented",
       [](Session& client) { client.start().say("SetActiveObjective:FindBottle"); }},
      {"kinovazed.host.number", bad_while_steering("MoveJoystick:1.9:0:0")},
      {"kinovazed.host.number-range", bad_while_steering("MoveJoystick:2147483648:0:0")},
      {"kinovazed.host.deflection", bad_while_steering("MoveJoystick:0:0:-1001")},

      {"kinovazed.host.one-connection",
       [](Session& client) {
         client.look();
         const auto second = client.make_port();
         EXPECT_TRUE(second->connect(second->now()));
         client.wait(1s);
       }},
      {"kinovazed.host.looks-first", [](Session& client) { client.connect().say("QuitEStop"); }},
      {"kinovazed.host.silent-server",
       [](Session& client) {
         client.steer();
         EXPECT_TRUE(client.touch("arm.fail.velocity_read", 1));
         client.wait(5s).say("MoveJoystick:0:0:0", 1s).say("MoveJoystick:0:0:0");
       }},
      {"kinovazed.host.leaves-answered",
       [](Session& client) { client.start().write("Freeze\r\n").port().reset(); }},
      {"kinovazed.host.leaves-stick",
       [](Session& client) { client.steer().say("MoveJoystick:0:0:40").leave(); }},
      {"kinovazed.host.leaves-motion",
       [](Session& client) { client.start().say("Retract").leave(); }},

      {"kinovazed.host.one-at-a-time",
       [](Session& client) { client.look().write("EStop\r\nQuitEStop\r\nInitialize\r\n"); }},
      {"kinovazed.host.estop-once",
       [](Session& client) { client.start().write("EStop\r\nEStop\r\n").wait(110ms); }},
      {"kinovazed.host.stick-pace",
       [](Session& client) {
         client.steer();
         for (int i = 0; i < 60; ++i) client.say("MoveJoystick:1:0:0", 33ms);
       },
       {{"call-us", "0"}}},

      {"kinovazed.host.initialize-first",
       [](Session& client) { client.look().say("QuitEStop").say("Retract"); }},
      {"kinovazed.host.sees-stop",
       [](Session& client) {
         client.steer();
         EXPECT_TRUE(client.touch("arm.fail.status_read", 1));
         client.wait(2s).say("MoveJoystick:0:0:0");
       }},
      {"kinovazed.host.waits-for-event",
       [](Session& client) { client.start().say("Retract").say("Unfold"); }},
      {"kinovazed.host.mode-settles",
       [](Session& client) {
         client.start().say("SetJoystickMode:XYZ").say("MoveJoystick:0:0:0");
       }},
      {"kinovazed.host.mode-pause",
       [](Session& client) {
         client.start().say("SetJoystickMode:XYZ").say("EStop").say("QuitEStop", 50ms);
         client.say("Initialize").say("SetJoystickMode:Rotation");
       },
       {{"call-us", "100"}}},
      {"kinovazed.host.stick-mode",
       [](Session& client) {
         client.steer().say("Freeze").say("Unfreeze").say("MoveJoystick:0:0:0");
       }},
      {"kinovazed.host.steering-exit", [](Session& client) { client.steer().say("Retract"); }},
      {"kinovazed.host.unfold-first",
       [](Session& client) { client.start().say("Retract", 5s).say("RunObjective:Home"); }},
      {"kinovazed.host.unfreeze-first",
       [](Session& client) { client.start().say("Freeze").say("RunObjective:Home"); }},
      {"kinovazed.host.nothing-to-undo", [](Session& client) { client.start().say("QuitEStop"); }},

      {"kinovazed.host.objective-runs",
       [](Session& client) { client.start().say("RunObjective:Handle").say("Freeze"); }},
      {"kinovazed.host.objective-patience",
       [](Session& client) { client.start().say("RunObjective:OpenDoor").wait(100s); },
       {{"plant", "jaco"}}},
      {"kinovazed.host.active-objective",
       [](Session& client) {
         client.start().say("RunObjective:Handle").say("SetActiveObjective:Home");
       }},
      {"kinovazed.host.chosen-objective",
       [](Session& client) { client.start().say("GetObjectivePosition"); }},
  };
}

class EachClientRequirement : public testing::TestWithParam<WrongClient> {};

TEST_P(EachClientRequirement, IsBrokenByAClientThatBreaksNoOther) {
  Session session{GetParam().options};
  GetParam().run(session);
  EXPECT_THAT(session.broken(), testing::ElementsAre(std::string{GetParam().requirement}));
  EXPECT_THAT(session.said_of(GetParam().requirement), testing::Not(testing::IsEmpty()));
}

INSTANTIATE_TEST_SUITE_P(Kinovazed, EachClientRequirement, testing::ValuesIn(wrong_clients()));

TEST(ClientRequirements, AreAllBrokenBySomeClient) {
  std::set<std::string_view> tried;
  for (const auto& wrong : wrong_clients()) tried.insert(wrong.requirement);
  std::set<std::string_view> all;
  for (const auto& requirement : host_requirements()) all.insert(requirement.id);
  EXPECT_EQ(tried, all);
  EXPECT_GE(all.size(), 20U);
}

TEST(ClientRequirements, ArePassedOnlyByAClientThatCouldBreakThem) {
  Session shy;
  shy.look().say("EStop").leave();
  const auto passed = shy.rows_with(Verdict::kPass);
  EXPECT_THAT(passed,
              testing::IsSupersetOf({"kinovazed.host.line-end", "kinovazed.host.leaves-answered",
                                     "kinovazed.host.initialize-first"}));
  for (const auto* id : {"kinovazed.host.leaves-stick", "kinovazed.host.unfold-first",
                         "kinovazed.host.mode-pause", "kinovazed.host.active-objective"}) {
    EXPECT_FALSE(passed.contains(id)) << id;
  }
  Session bold;
  bold.steer().say("MoveJoystick:9:0:0").say("MoveJoystick:0:0:0").say("SetJoystickMode:NoMode");
  bold.say("RunObjective:Home", 1s).wait(5s).leave();
  EXPECT_THAT(
      bold.rows_with(Verdict::kPass),
      testing::IsSupersetOf({"kinovazed.host.leaves-stick", "kinovazed.host.waits-for-event",
                             "kinovazed.host.objective-runs", "kinovazed.host.stick-mode",
                             "kinovazed.host.mode-settles"}));
}

void rest(Client& client, Duration duration) {
  for (const auto end = client.now() + duration; client.now() < end;) {
    if (!client.poll(end)) return;
    (void)client.take_events();
  }
}

/// What our own client does on a long day.
void use_everything(Client& client) {
  const auto is_done = [](const Result<CallResult>& result) { return result && result->is_done(); };
  ASSERT_TRUE(client.connect(client.now() + 3s));
  ASSERT_TRUE(is_done(client.estop()));
  ASSERT_TRUE(is_done(client.quit_estop()));
  ASSERT_TRUE(is_done(client.initialize()));
  ASSERT_TRUE(is_done(client.retract()));
  ASSERT_TRUE(is_done(client.unfold()));
  ASSERT_TRUE(is_done(client.freeze()));
  ASSERT_TRUE(is_done(client.unfreeze()));
  for (const auto mode : {Mode::kXyz, Mode::kRotation, Mode::kAxis1to3, Mode::kAxis4to6}) {
    ASSERT_TRUE(is_done(client.set_joystick_mode(mode)));
    for (int i = 0; i < 30; ++i) {
      ASSERT_TRUE(is_done(client.move_joystick({i, -i, 2})));
      rest(client, 70ms);
    }
    ASSERT_TRUE(is_done(client.move_joystick({})));
  }
  ASSERT_TRUE(is_done(client.run_objective(Objective::kHome)));
  const auto end = client.now() + 700ms;
  ASSERT_TRUE(client.run_objective(Objective::kHandle,
                                   {.is_cancelled = [&] { return client.now() >= end; }}));
  rest(client, 2s);
  ASSERT_TRUE(is_done(client.set_joystick_mode(Mode::kXyz)));
  ASSERT_TRUE(is_done(client.move_joystick({100, 0, 0})));
}

class OurOwnClient : public testing::TestWithParam<DeviceOptions> {};

TEST_P(OurOwnClient, DoesNothingWrong) {
  Session session{GetParam()};
  const bool is_documented = GetParam().contains("profile");
  const DriveOptions options{.profile = is_documented ? Profile::kDocumented : Profile::kFirmware};
  for (int i = 0; i < 2; ++i) {  // and leaves as it should
    Client client{session.port(), options};
    ASSERT_NO_FATAL_FAILURE(use_everything(client));
  }
  EXPECT_THAT(session.broken(), testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Kinovazed, OurOwnClient,
                         testing::Values(DeviceOptions{}, DeviceOptions{{"plant", "jaco"}},
                                         DeviceOptions{{"call-us", "1000"}},
                                         DeviceOptions{{"race", "event"}},
                                         DeviceOptions{{"race", "random"}},
                                         DeviceOptions{{"profile", "documented"}}));

TEST(OurOwnClient, RecoversFromAnErrorOfTheArmWithoutDoingWrong) {
  Session session;
  {
    Client client{session.port()};
    ASSERT_NO_FATAL_FAILURE(use_everything(client));
    rest(client, 1s);
    ASSERT_TRUE(session.touch("arm.fail.status_read", 1));
    rest(client, 3s);
    ASSERT_TRUE(client.quit_estop());
    ASSERT_TRUE(client.initialize());
  }
  EXPECT_THAT(session.broken(), testing::IsEmpty());
}

TEST(OurOwnClient, LeavesASilentServerWithoutDoingWrong) {
  Session session;
  {
    Client client{session.port()};
    ASSERT_NO_FATAL_FAILURE(use_everything(client));
    ASSERT_TRUE(session.touch("arm.fail.velocity_read", 1));
    rest(client, 10s);
    EXPECT_FALSE(client.drive().heartbeat()) << "it has connected anew";
  }
  EXPECT_THAT(session.broken(), testing::IsEmpty());
}

/// What the recorded client broke. That all begin with QuitEStop is left out: they knew what they
/// would find.
std::set<std::string> broken_in(const Trace& trace) {
  using Kind = ConnectionEvent::Kind;
  static const std::map<std::string_view, Kind> kKinds{{"connect", Kind::kBegun},
                                                       {"to_device", Kind::kToServer},
                                                       {"from_device", Kind::kFromServer},
                                                       {"disconnect", Kind::kClosed}};
  const auto checker = program_check().make({});
  for (const auto& event : trace.events) {
    const auto found = kKinds.find(event.dir);
    if (found == kKinds.end()) continue;
    const bool is_by_server = event.json.find("device-eof") != std::string::npos;
    const auto kind = is_by_server ? Kind::kDropped : found->second;
    checker->on_connection({event.time, event.id, kind, event.bytes});
  }
  std::set<std::string> ids;
  for (const auto& offence : checker->take_offences()) ids.emplace(offence.requirement);
  ids.erase("kinovazed.host.looks-first");
  return ids;
}

Trace recording(const std::string& name) {
  return *read_trace(source_dir() + "/captures/kinovazed/" + name + ".jsonl");
}

/// Most of the recorded clients are good, others are wrong in the ways that they are named for.
struct Recorded {
  const char* name;
  std::vector<std::string> broken{};
};
void PrintTo(const Recorded& recorded, std::ostream* out) { *out << recorded.name; }

class RecordedClient : public testing::TestWithParam<Recorded> {};

TEST_P(RecordedClient, IsBlamedForWhatItDid) {
  EXPECT_THAT(broken_in(recording(GetParam().name)),
              testing::UnorderedElementsAreArray(GetParam().broken));
}

INSTANTIATE_TEST_SUITE_P(
    Kinovazed, RecordedClient,
    testing::Values(
        Recorded{"session-arm-already-ready"}, Recorded{"session-estop-mid-retract"},
        Recorded{"session-freeze-cycle"}, Recorded{"session-joystick-modes"},
        Recorded{"session-retract-unfold"}, Recorded{"session-startup"},
        Recorded{"objectives-absolute"}, Recorded{"objectives-current"}, Recorded{"estop-flap"},
        Recorded{"repeat-initialize-swapped"}, Recorded{"repeat-retract"},
        Recorded{"interrupt-objective-by-mode"}, Recorded{"interrupt-setting-mode-by-estop"},
        Recorded{"framing-crlf"}, Recorded{"framing-byte-by-byte"},
        Recorded{"defect-mode-change-late-enough"}, Recorded{"fault-unplug-idle"},
        Recorded{"connection-reconnect-idle"}, Recorded{"connection-server-stops"},
        Recorded{"connection-half-close", {"kinovazed.host.leaves-answered"}},
        Recorded{"connection-reconnect-mid-objective", {"kinovazed.host.leaves-motion"}},
        Recorded{"connection-second-waits", {"kinovazed.host.one-connection"}},
        Recorded{"defect-mode-change-too-soon", {"kinovazed.host.mode-pause"}},
        Recorded{"fault-status-steering", {"kinovazed.host.sees-stop"}},
        Recorded{"framing-case", {"kinovazed.host.word-case"}},
        Recorded{"framing-lf", {"kinovazed.host.line-end"}},
        Recorded{"framing-nul", {"kinovazed.host.line-ascii"}},
        Recorded{"framing-pipelined", {"kinovazed.host.one-at-a-time"}},
        Recorded{"interrupt-retracting-refused", {"kinovazed.host.waits-for-event"}},
        Recorded{"interrupt-setting-mode-by-mode", {"kinovazed.host.mode-settles"}},
        Recorded{"joystick-numbers-bad", {"kinovazed.host.number"}},
        Recorded{
            "joystick-numbers-tail",
            {"kinovazed.host.number", "kinovazed.host.bare-line", "kinovazed.host.leaves-stick"}}));

bool is_of_state(std::string_view requirement) {
  static const std::set<std::string_view> kOfState{
      "kinovazed.host.initialize-first", "kinovazed.host.waits-for-event",
      "kinovazed.host.mode-settles",     "kinovazed.host.stick-mode",
      "kinovazed.host.steering-exit",    "kinovazed.host.unfold-first",
      "kinovazed.host.unfreeze-first",   "kinovazed.host.nothing-to-undo",
      "kinovazed.host.objective-runs"};
  return kOfState.contains(requirement);
}

/// The matrix of recordings has each command in each state.
TEST(RecordedClients, AreBlamedForTheStateWhereTheServerRejected) {
  const auto paths = *find_traces({source_dir() + "/captures/kinovazed/matrix"});
  ASSERT_GT(paths.size(), 50U);
  for (const auto& path : paths) {
    const auto trace = *read_trace(path);
    const bool is_rejected = std::ranges::any_of(trace.events, [](const TraceEvent& event) {
      return event.json.find("Rejected") != std::string::npos;
    });
    const bool may_recur = path.find("retracted-Retract") != std::string::npos ||
                           path.find("frozen-Freeze") != std::string::npos;
    const auto broken = broken_in(trace);
    EXPECT_EQ(std::ranges::any_of(broken, is_of_state), is_rejected && !may_recur) << path;
  }
}

}  // namespace
}  // namespace armjig::kinovazed::programs
