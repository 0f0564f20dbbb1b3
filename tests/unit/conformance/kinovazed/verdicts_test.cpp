// SPDX-License-Identifier: Apache-2.0
// What a run says of servers whose answers nobody understands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "conformance/kinovazed/suite.hpp"
#include "conformance/run.hpp"
#include "harness/core/bytes.hpp"
#include "harness/link/port_around.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using testing::HasSubstr;

/// One byte of the server becomes another one, or none.
using Change = std::function<std::string(char)>;

/// A connection to a server whose bytes are changed before they are read. None gets longer.
class ChangedSession final : public SessionAround {
 public:
  ChangedSession(std::unique_ptr<SessionPort> port, Change change,
                 std::shared_ptr<std::size_t> sent)
      : PortAround{std::move(port)}, change_{std::move(change)}, sent_{std::move(sent)} {}

  Result<void> connect(Instant deadline) override { return inner().connect(deadline); }
  Result<void> send(Bytes segment) override {
    if (sent_ != nullptr) *sent_ += segment.size();
    return inner().send(segment);
  }
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    auto received = inner().receive(into, deadline);
    if (!received) return received;
    std::string text;
    for (const auto byte : into.first(received->size)) text += change_(static_cast<char>(byte));
    std::ranges::copy(std::as_bytes(std::span{text}), into.begin());
    received->size = text.size();
    return received;
  }
  void half_close() override { inner().half_close(); }
  void close() override { inner().close(); }
  void reset() override { inner().reset(); }

 private:
  Change change_;
  std::shared_ptr<std::size_t> sent_;  ///< bytes, of all clients; nobody counts if none
};

/// A server in memory that nobody can touch.
class ChangedServer final : public SourceAround {
 public:
  explicit ChangedServer(const Change& change, std::shared_ptr<std::size_t> sent = nullptr)
      : SourceAround{test::wiring<cli::OnServer>("kinovazed")
                         .open_emulated(parse_target("emulated:").value())
                         .value(),
                     [change, sent](std::unique_ptr<SessionPort> port) {
                       return std::make_unique<ChangedSession>(std::move(port), change, sent);
                     }} {}
  bool touch(std::string_view /*input*/, std::int64_t /*value*/) override { return false; }
};

/// A connection to a server that one line ends.
class MortalSession final : public SessionAround {
 public:
  MortalSession(std::unique_ptr<SessionPort> port, std::shared_ptr<bool> is_dead)
      : PortAround{std::move(port)}, is_dead_{std::move(is_dead)} {}

  Result<void> connect(Instant deadline) override {
    if (*is_dead_) return tl::unexpected{Error{ErrorCode::kRefused, 0}};
    return inner().connect(deadline);
  }
  Result<void> send(Bytes segment) override {
    *is_dead_ = *is_dead_ || as_text(segment).find("PlaceBottle") != std::string_view::npos;
    return inner().send(segment);
  }
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    if (*is_dead_) return tl::unexpected{Error{ErrorCode::kDisconnected, 0}};
    return inner().receive(into, deadline);
  }
  void half_close() override { inner().half_close(); }
  void close() override { inner().close(); }
  void reset() override { inner().reset(); }

 private:
  std::shared_ptr<bool> is_dead_;
};

/// Only its restart brings it back.
class MortalServer final : public SourceAround {
 public:
  explicit MortalServer(std::shared_ptr<bool> is_dead)
      : SourceAround{test::wiring<cli::OnServer>("kinovazed")
                         .open_emulated(parse_target("emulated:").value())
                         .value(),
                     [is_dead](std::unique_ptr<SessionPort> port) {
                       return std::make_unique<MortalSession>(std::move(port), is_dead);
                     }},
        is_dead_{std::move(is_dead)} {}
  bool touch(std::string_view input, std::int64_t value) override {
    if (input == "restart") *is_dead_ = false;
    return SourceAround::touch(input, value);
  }

 private:
  std::shared_ptr<bool> is_dead_;
};

/// A connection on which all comes 300 ms late from a certain EStop on, and that one 900 ms.
class LateSession final : public SessionAround {
 public:
  using PortAround::PortAround;

  Result<void> connect(Instant deadline) override { return inner().connect(deadline); }
  Result<void> send(Bytes segment) override {
    const auto text = as_text(segment);
    const bool is_first = !last_due_ && is_armed_ && text == "EStop\r\n";
    is_armed_ = is_armed_ || text == "MoveJoystick:1:1:1\r\n";
    if (!is_first && !last_due_) return inner().send(segment);
    last_due_ = is_first ? now() + kFirst : std::max(*last_due_, now()) + kOthers;
    held_.emplace_back(*last_due_, text);
    return {};
  }
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    while (!held_.empty() && held_.front().first <= deadline) {
      auto received = inner().receive(into, held_.front().first);
      if (!received || received->arrival != Arrival::kDeadline) return received;
      const auto text = held_.front().second;
      held_.pop_front();
      (void)inner().send(std::as_bytes(std::span{text}));
    }
    return inner().receive(into, deadline);
  }
  void half_close() override { inner().half_close(); }
  void close() override { inner().close(); }
  void reset() override { inner().reset(); }

 private:
  static constexpr auto kFirst = std::chrono::milliseconds{900};
  static constexpr auto kOthers = std::chrono::milliseconds{300};
  bool is_armed_ = false;
  std::optional<Instant> last_due_;
  std::deque<std::pair<Instant, std::string>> held_;
};

std::string unchanged(char c) { return std::string{c}; }

/// A client makes it move and leaves.
void steer(SessionSource& server) {
  using namespace std::chrono_literals;
  const auto client = server.make_port();
  ASSERT_TRUE(client->connect(client->now() + 2s));
  for (const std::string_view line :
       {"QuitEStop\r\n", "Initialize\r\n", "SetJoystickMode:XYZ\r\n"}) {
    ASSERT_TRUE(client->send(std::as_bytes(std::span{line})));
    std::array<std::byte, 4096> buffer;
    for (const auto end = client->now() + 20s; client->now() < end;) {
      ASSERT_TRUE(client->receive(buffer, end));
    }
  }
  client->close();
}

/// All cases that only look, on a server that is no emulated one as far as the bench knows.
Report look_at(std::unique_ptr<ChangedServer> server) {
  const RigOptions how{.target = parse_target("tcp:localhost:1").value()};
  const auto bench = make_bench(Rig<SessionSource>{std::move(server)}, how);
  return run_suite(suite(), **bench, {}, [](const ReportRow&) {});
}

Report run(const Change& change) {
  const auto bench = make_bench(Rig<SessionSource>{std::make_unique<ChangedServer>(change)},
                                {.permissions = Permissions::all()});
  RunOptions options;
  options.selection.filter = "kinovazed.reply.words";
  options.permissions = Permissions::all();
  return run_suite(suite(), **bench, options, [](const ReportRow&) {});
}

Change instead_of(char from, std::string to) {
  return [from, to = std::move(to)](char c) { return c == from ? to : std::string{c}; };
}

/// That the first row is the finding, and what of it is shown.
void expect_finding(const Report& report, std::string_view layout, std::string_view bytes) {
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings);
  ASSERT_FALSE(report.rows.empty());
  const auto& row = report.rows.front();
  EXPECT_EQ(row.name, "kinovazed.alive");
  EXPECT_EQ(row.verdict, Verdict::kFail);
  EXPECT_THAT(row.expected, HasSubstr(std::string{layout}));
  EXPECT_THAT(row.actual, HasSubstr(std::string{bytes}));
}

TEST(ServerVerdicts, LinesThatEndWithLfAloneAreTheFinding) {
  expect_finding(run(instead_of('\r', "")), "CR LF", R"('Accepted\x0A')");
}

TEST(ServerVerdicts, LinesThatEndWithoutLfAreTheFinding) {
  expect_finding(run(instead_of('\n', "\r")), "CR LF", R"(Accepted\x0D\x0D)");
}

TEST(ServerVerdicts, WordsInLowerCaseAreTheFinding) {
  expect_finding(
      run([](char c) {
        return std::string{static_cast<char>(std::tolower(static_cast<unsigned char>(c)))};
      }),
      "one of the server's words and CR LF", R"('accepted\x0D\x0A')");
}

TEST(ServerVerdicts, WordsThatAreTooShortAreTheFinding) {
  expect_finding(run(instead_of('d', "")), "one of the server's words and CR LF",
                 R"('Accepte\x0D\x0A')");
}

TEST(ServerVerdicts, AnUnchangedServerPasses) {
  EXPECT_EQ(conclusion_of(run(unchanged)), Conclusion::kPassed);
}

/// What becomes of a server at some time: it is off, or takes no bytes in and beats on.
enum class Breaks { kOff, kDeaf };

/// A connection to such a server.
class BrokenSession final : public SessionAround {
 public:
  BrokenSession(std::unique_ptr<SessionPort> port, Instant end, Breaks how)
      : PortAround{std::move(port)}, end_{end}, how_{how} {}

  Result<void> connect(Instant deadline) override {
    if (is_off()) return fail(ErrorCode::kRefused);
    return inner().connect(deadline);
  }
  Result<void> send(Bytes segment) override {
    if (is_off()) return fail(ErrorCode::kDisconnected);
    if (now() >= end_) return {};
    return inner().send(segment);
  }
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    if (is_off()) return Received{Arrival::kReset, 0};
    if (how_ == Breaks::kDeaf) return inner().receive(into, deadline);
    return inner().receive(into, std::min(deadline, std::max(end_, now())));
  }
  void half_close() override { inner().half_close(); }
  void close() override { inner().close(); }
  void reset() override { inner().reset(); }

 private:
  [[nodiscard]] bool is_off() const { return how_ == Breaks::kOff && now() >= end_; }

  Instant end_;
  Breaks how_;
};

class BrokenServer final : public SourceAround {
 public:
  explicit BrokenServer(Duration life, Breaks how = Breaks::kOff)
      : SourceAround{test::wiring<cli::OnServer>("kinovazed")
                         .open_emulated(parse_target("emulated:").value())
                         .value(),
                     [this, life, how](std::unique_ptr<SessionPort> port) {
                       if (!end_) end_ = port->now() + life;
                       return std::make_unique<BrokenSession>(std::move(port), *end_, how);
                     }} {}

 private:
  std::optional<Instant> end_;
};

Report run_broken(const Selection& selection, Duration life, Breaks how) {
  const auto bench = make_bench(Rig<SessionSource>{std::make_unique<BrokenServer>(life, how)},
                                {.permissions = Permissions::all()});
  RunOptions options;
  options.selection = selection;
  options.permissions = Permissions::all();
  return run_suite(suite(), **bench, options, [](const ReportRow&) {});
}

void expect_no_finding(const Selection& selection, Duration life) {
  const auto report = run_broken(selection, life, Breaks::kOff);
  for (const auto& row : report.rows) {
    EXPECT_NE(row.verdict, Verdict::kFail) << life.count() << " ns: " << to_text(row);
  }
  EXPECT_GE(report.count(Verdict::kError), 1U) << life.count() << " ns";
}

TEST(ServerVerdicts, AServerThatIsSwitchedOffIsNoFinding) {
  using namespace std::chrono_literals;
  Selection quick;
  quick.tier = Tier::kQuick;
  for (Duration life = 1ms; life < 30s; life += 370ms) expect_no_finding(quick, life);
}

TEST(ServerVerdicts, AServerThatIsSwitchedOffWhileItsBeatsAreCountedIsNoFinding) {
  using namespace std::chrono_literals;
  Selection beats;
  beats.filter = "kinovazed.beat.";
  for (Duration life = 1ms; life < 30s; life += 370ms) expect_no_finding(beats, life);
}

TEST(ServerVerdicts, AServerThatBeatsOnAndDoesNotAnswerIsAFinding) {
  using namespace std::chrono_literals;
  Selection quick;
  quick.tier = Tier::kQuick;
  for (Duration life = 1ms; life < 20s; life += 1370ms) {
    const auto report = run_broken(quick, life, Breaks::kDeaf);
    EXPECT_EQ(conclusion_of(report), Conclusion::kFindings) << life.count() << " ns";
    EXPECT_EQ(report.count(Verdict::kError), 0U) << life.count() << " ns";
    EXPECT_TRUE(std::ranges::any_of(report.rows,
                                    [](const ReportRow& row) {
                                      return row.name == "kinovazed.alive" &&
                                             row.verdict == Verdict::kFail &&
                                             row.actual == "heartbeats and no answer";
                                    }))
        << life.count() << " ns";
  }
}

TEST(ServerVerdicts, AServerThatALineEndsHasFailedThatCaseAndIsAskedTheOthers) {
  const auto bench =
      make_bench(Rig<SessionSource>{std::make_unique<MortalServer>(std::make_shared<bool>(false))},
                 {.permissions = Permissions::all()});
  RunOptions options;
  options.selection.filter = "kinovazed.state";
  options.selection.tier = Tier::kQuick;
  options.permissions = Permissions::all();
  const auto report = run_suite(suite(), **bench, options, [](const ReportRow&) {});
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings);
  EXPECT_EQ(report.count(Verdict::kError), 0U);
  EXPECT_GT(report.count(Verdict::kPass), 20U);
  const auto table = std::ranges::find(report.rows, "kinovazed.state.table", &ReportRow::name);
  ASSERT_NE(table, report.rows.end());
  EXPECT_EQ(table->verdict, Verdict::kFail);
  EXPECT_THAT(table->actual, HasSubstr("the end of the connection, twice"));
}

/// Or its answer would be taken for that of a later command.
TEST(ServerVerdicts, AnAnswerThatComesTooLateAccusesNoOtherCase) {
  auto server = test::wiring<cli::OnServer>("kinovazed")
                    .open_emulated(parse_target("emulated:").value())
                    .value();
  auto late =
      std::make_unique<SourceAround>(std::move(server), [](std::unique_ptr<SessionPort> port) {
        return std::make_unique<LateSession>(std::move(port));
      });
  const auto bench =
      make_bench(Rig<SessionSource>{std::move(late)}, {.permissions = Permissions::all()});
  RunOptions options;
  options.selection.filter = "kinovazed.time";
  options.selection.tier = Tier::kFull;
  options.permissions = Permissions::all();
  const auto report = run_suite(suite(), **bench, options, [](const ReportRow&) {});
  EXPECT_GE(report.rows.size(), 5U);
  for (const auto& row : report.rows) {
    if (row.name != "kinovazed.time.answer.stopped") {
      EXPECT_EQ(row.verdict, Verdict::kPass)
          << row.name << ": " << row.expected << " / " << row.actual;
    }
  }
}

TEST(OnlyLooking, SendsNothingToAnArmThatIsInUse) {
  const auto sent = std::make_shared<std::size_t>();
  auto server = std::make_unique<ChangedServer>(unchanged, sent);
  steer(*server);
  *sent = 0;
  const auto report = look_at(std::move(server));
  EXPECT_EQ(*sent, 0U);
  EXPECT_EQ(report.count(Verdict::kSkipped), report.rows.size());
  EXPECT_TRUE(std::ranges::any_of(report.rows, [](const ReportRow& row) {
    return row.actual == "the arm is in use (Heartbeat:69), and needs --allow state to be stopped";
  }));
}

TEST(OnlyLooking, JudgesAnArmThatIsStopped) {
  const auto report = look_at(std::make_unique<ChangedServer>(unchanged));
  EXPECT_GE(report.count(Verdict::kPass), 40U);
  EXPECT_EQ(report.count(Verdict::kFail), 0U);
}

}  // namespace
}  // namespace armjig::kinovazed::conformance
