// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/guarded_ports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/rig/kinovazed_judge.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;

/// Writes down what it is told; never answers.
class Recorder final : public SessionPort {
 public:
  explicit Recorder(std::vector<std::string>& notes) : notes_{notes} {}

  Result<void> connect(Instant /*deadline*/) override {
    notes_.emplace_back("connect");
    return {};
  }
  Result<void> send(Bytes segment) override {
    std::string text;
    for (const auto byte : segment) {
      const auto c = static_cast<char>(byte);
      if (c != '\r') text.push_back(c == '\n' ? ';' : c);
    }
    notes_.push_back(text);
    return {};
  }
  Result<Received> receive(std::span<std::byte> /*into*/, Instant deadline) override {
    now_ = deadline;
    return Received{Arrival::kDeadline, 0};
  }
  void half_close() override { notes_.emplace_back("half-close"); }
  void close() override { notes_.emplace_back("close"); }
  void reset() override { notes_.emplace_back("reset"); }
  [[nodiscard]] Instant now() const override { return now_; }

 private:
  std::vector<std::string>& notes_;
  Instant now_{};
};

class SessionGuard : public ::testing::Test {
 protected:
  void open(Permissions permissions) {
    port = std::make_unique<GuardedSession>(std::make_unique<Recorder>(notes),
                                            kinovazed::rig::make_judge(), permissions);
    ASSERT_TRUE(port->connect({}));
  }
  Result<void> send(std::string_view text) { return port->send(std::as_bytes(std::span{text})); }

  std::vector<std::string> notes;
  std::unique_ptr<GuardedSession> port;
};

TEST_F(SessionGuard, WritesNothingOfWhatIsNotAllowed) {
  open({});
  EXPECT_TRUE(send("EStop\r\n"));
  EXPECT_EQ(send("EStop\r\nRetract\r\n").error().code, ErrorCode::kForbidden);
  EXPECT_EQ(port->last_refusal()->reason, "Retract needs --allow move");
  EXPECT_THAT(notes, ElementsAre("connect", "EStop;"));
}

TEST_F(SessionGuard, StopsAMovingArmBeforeAnyEndOfTheConnection) {
  open(Permissions::all());
  EXPECT_TRUE(send("Retract\r\n"));
  port->close();
  EXPECT_THAT(notes, ElementsAre("connect", "Retract;", ";EStop;", "close"));
  notes.clear();
  ASSERT_TRUE(port->connect({}));
  port->reset();
  EXPECT_THAT(notes, ElementsAre("connect", ";EStop;", "reset"));
  notes.clear();
  ASSERT_TRUE(port->connect({}));
  port.reset();
  EXPECT_THAT(notes, ElementsAre("connect", ";EStop;", "close"));
}

TEST_F(SessionGuard, StopsAMovingArmWhenItRefusesSomething) {
  open(parse_permissions("move").value());
  EXPECT_TRUE(send("Retract\r\n"));
  EXPECT_EQ(send("QuitEStop\r\n").error().code, ErrorCode::kForbidden);
  EXPECT_THAT(notes, ElementsAre("connect", "Retract;", ";EStop;"));
  EXPECT_EQ(port->last_refusal()->reason, "QuitEStop needs --allow state");
  EXPECT_EQ(port->last_refusal()->cause, Refusal::Cause::kRequest);
}

TEST_F(SessionGuard, SaysNothingAtAnEndThatSomebodyLooksAtUnlessItGoesItself) {
  const auto state = std::make_shared<GuardState>();
  state->when_left = WhenLeft::kSayNothing;
  port = std::make_unique<GuardedSession>(std::make_unique<Recorder>(notes),
                                          kinovazed::rig::make_judge(), Permissions::all(), state);
  ASSERT_TRUE(port->connect({}));
  EXPECT_TRUE(send("Retract\r\n"));
  port->close();
  EXPECT_THAT(notes, ElementsAre("connect", "Retract;", "close"));
  notes.clear();
  ASSERT_TRUE(port->connect({}));
  port.reset();
  EXPECT_THAT(notes, ElementsAre("connect", ";EStop;", "close"));
}

/// Ports that note what they do, all in one list.
class Server final : public SessionSource {
 public:
  explicit Server(std::vector<std::string>& notes) : notes_{notes} {}
  std::unique_ptr<SessionPort> make_port() override { return std::make_unique<Recorder>(notes_); }
  void pause(Duration /*duration*/) override {}
  [[nodiscard]] Instant now() const override { return {}; }

 private:
  std::vector<std::string>& notes_;
};

class SourceGuard : public ::testing::Test {
 protected:
  SourceGuard() { state->when_left = WhenLeft::kSayNothing; }
  void open_source() {
    source = std::make_unique<GuardedSource>(std::make_unique<Server>(notes),
                                             kinovazed::rig::make_judge, Permissions::all(), state);
    port = source->make_port();
    ASSERT_TRUE(port->connect({}));
  }
  Result<void> send(std::string_view text) { return port->send(std::as_bytes(std::span{text})); }

  std::vector<std::string> notes;
  std::shared_ptr<GuardState> state = std::make_shared<GuardState>();
  std::unique_ptr<GuardedSource> source;
  std::unique_ptr<SessionPort> port;
};

TEST_F(SourceGuard, StopsAtItsEndWhatAClientLeftMoving) {
  open_source();
  EXPECT_TRUE(send("Retract\r\n"));
  port->close();
  port = source->make_port();
  ASSERT_TRUE(port->connect({}));
  port->close();
  notes.clear();
  source.reset();
  EXPECT_THAT(notes, ElementsAre("connect", ";EStop;", "close"));
}

TEST_F(SourceGuard, SaysNothingAtItsEndIfNothingWasLeftMoving) {
  open_source();
  EXPECT_TRUE(send("Retract\r\n"));
  port.reset();
  EXPECT_EQ(notes.back(), "close");
  notes.clear();
  source.reset();
  EXPECT_THAT(notes, ElementsAre());
}

TEST_F(SessionGuard, LetsAConnectionEndThatMovedNothing) {
  open(Permissions::all());
  EXPECT_TRUE(send("QuitEStop\r\n"));
  port->half_close();
  port->close();
  EXPECT_THAT(notes, ElementsAre("connect", "QuitEStop;", "half-close", "close"));
}

TEST_F(SessionGuard, EndsTheHalfSentLineOfALostConnection) {
  open({});
  EXPECT_TRUE(send("      MoveJoy"));
  port->close();
  ASSERT_TRUE(port->connect({}));
  EXPECT_THAT(notes, ElementsAre("connect", "      MoveJoy", "close", "connect", ";"));
}

TEST_F(SessionGuard, PutsNothingIntoALineThatComesInPieces) {
  open({});
  EXPECT_TRUE(send("ESto"));
  EXPECT_TRUE(send("p\r\n"));
  EXPECT_THAT(notes, ElementsAre("connect", "ESto", "p;"));
}

TEST_F(SessionGuard, LeavesARestThatCannotBecomeACommandToTheNextClient) {
  open({});
  const std::string junk(128, 'B');
  EXPECT_TRUE(send(junk));
  port->close();
  ASSERT_TRUE(port->connect({}));
  EXPECT_TRUE(send("EStop\r\n"));
  EXPECT_THAT(notes, ElementsAre("connect", junk, "close", "connect", "EStop;"));
}

}  // namespace
}  // namespace armjig
