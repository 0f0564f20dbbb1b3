// SPDX-License-Identifier: Apache-2.0
#include "harness/link/tcp_session.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <string>

#include "tests/integration/support/program.hpp"
#include "tests/integration/support/sockets.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using Arrival = SessionPort::Arrival;
using testing::Listener;

Bytes sent_text(std::string_view text) { return std::as_bytes(std::span{text}); }

/// A server that does what the test says, and a session to it.
class TcpSession : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = make_tcp_session(listener.address());
    ASSERT_TRUE(made);
    session = std::move(*made);
    ASSERT_TRUE(session->connect(session->now() + testing::kPatience));
    peer = listener.accept();
  }

  Result<SessionPort::Received> receive(Duration within = testing::kPatience) {
    return session->receive(buffer, session->now() + within);
  }
  [[nodiscard]] std::string text(std::size_t size) const {
    std::string result;
    for (const auto byte : std::span{buffer}.first(size)) result += static_cast<char>(byte);
    return result;
  }
  void expect_arrival(Arrival arrival) {
    const auto received = receive();
    ASSERT_TRUE(received);
    EXPECT_EQ(received->arrival, arrival);
  }

  Listener listener;
  std::unique_ptr<SessionPort> session;
  Descriptor peer;
  std::array<std::byte, 64> buffer{};
};

TEST_F(TcpSession, CarriesSegmentsBothWays) {
  ASSERT_TRUE(session->send(sent_text("question")));
  EXPECT_EQ(testing::receive_plain(peer, 8), "question");
  testing::send_plain(peer, sent_text("answer"));
  const auto received = receive();
  ASSERT_TRUE(received);
  EXPECT_EQ(received->arrival, Arrival::kData);
  EXPECT_EQ(text(received->size), "answer");
}

TEST_F(TcpSession, SaysThatNothingCameInTime) {
  const auto received = receive(5ms);
  ASSERT_TRUE(received);
  EXPECT_EQ(received->arrival, Arrival::kDeadline);
}

TEST_F(TcpSession, TellsAnEndFromAReset) {
  peer.close();
  expect_arrival(Arrival::kEnd);
}

TEST_F(TcpSession, SaysTheEndAgainOnlyWhenTimeHasPassed) {
  peer.close();
  expect_arrival(Arrival::kEnd);
  const auto deadline = session->now() + 20ms;
  EXPECT_EQ(receive(20ms)->arrival, Arrival::kEnd);
  EXPECT_GE(session->now(), deadline) << "or what is delayed is waited for with a busy processor";
}

TEST_F(TcpSession, TellsAResetFromAnEnd) {
  testing::close_with_reset(peer);
  expect_arrival(Arrival::kReset);
  EXPECT_EQ(receive(), fail(ErrorCode::kDisconnected)) << "a reset ends the connection";
}

TEST_F(TcpSession, TellsAResetThatSendingFoundFirst) {
  testing::close_with_reset(peer);
  Result<void> sent;
  while (sent) sent = session->send(sent_text("x"));
  EXPECT_EQ(sent.error().code, ErrorCode::kDisconnected);
  expect_arrival(Arrival::kReset);
}

TEST_F(TcpSession, StillReadsAfterHalfClosing) {
  session->half_close();
  EXPECT_EQ(testing::receive_plain(peer, 1), "") << "the server sees the end";
  testing::send_plain(peer, sent_text("late"));
  const auto received = receive();
  ASSERT_TRUE(received);
  EXPECT_EQ(text(received->size), "late");
}

TEST_F(TcpSession, EndsInGoodOrderWithUnreadBytes) {
  testing::send_plain(peer, sent_text("unread"));
  ASSERT_EQ(receive()->arrival, Arrival::kData) << "they have come";
  testing::send_plain(peer, sent_text("unread"));
  session->close();
  std::byte byte{};
  EXPECT_EQ(::recv(peer.value(), &byte, 1, 0), 0) << "an end, no reset";
}

TEST_F(TcpSession, ThrowsTheConnectionAway) {
  session->reset();
  std::byte byte{};
  EXPECT_EQ(::recv(peer.value(), &byte, 1, 0), -1);
  EXPECT_EQ(errno, ECONNRESET);
}

TEST_F(TcpSession, ConnectsAgainAfterClosing) {
  session->close();
  ASSERT_TRUE(session->connect(session->now() + testing::kPatience));
  const auto next = listener.accept();
  ASSERT_TRUE(session->send(sent_text("again")));
  EXPECT_EQ(testing::receive_plain(next, 5), "again");
}

TEST_F(TcpSession, HasOneConnectionAtATime) {
  EXPECT_EQ(session->connect(session->now()), fail(ErrorCode::kBusy));
}

TEST_F(TcpSession, NeedsAConnection) {
  session->close();
  EXPECT_EQ(session->send(sent_text("x")), fail(ErrorCode::kDisconnected));
  EXPECT_EQ(receive(), fail(ErrorCode::kDisconnected));
}

TEST(TcpServer, HasOneClockForAllItsSessions) {
  const auto server = open_tcp_server("127.0.0.1:1");
  ASSERT_TRUE(server);
  const auto first = (*server)->make_port();
  while ((*server)->now() < at(1ms)) {
  }
  const auto before = (*server)->now();
  const auto second = (*server)->make_port();
  EXPECT_GE(second->now(), before);
  EXPECT_GE(first->now(), before);
}

TEST(TcpSessionWithoutServer, IsRefused) {
  const auto session = make_tcp_session(Listener{}.address());
  ASSERT_TRUE(session);
  const auto connected = (*session)->connect((*session)->now() + testing::kPatience);
  ASSERT_FALSE(connected);
  EXPECT_EQ(connected.error().code, ErrorCode::kRefused);
}

}  // namespace
}  // namespace armjig
