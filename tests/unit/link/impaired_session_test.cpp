// SPDX-License-Identifier: Apache-2.0
#include "harness/link/impaired_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/demo/demo.hpp"
#include "harness/link/memory_session.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using test::ByteVector;
using test::hex;
using ::testing::ElementsAre;
using Arrival = SessionPort::Arrival;

/// A server that notes everything as text with the time in milliseconds, echoes each segment at
/// once, and ends or resets when told to.
struct SessionRecorder {
  std::vector<std::string> notes;
  std::vector<SessionEvent> events;

  void note(Instant time, const std::string& what) {
    notes.push_back(std::to_string(microseconds(time) / 1000) + " " + what);
  }
  void connect(Instant time) { note(time, "connect"); }
  void receive(Instant time, Bytes bytes) {
    note(time, to_hex(bytes));
    const auto first = std::to_integer<int>(bytes.front());
    if (first == 0xEE) events.push_back({time, SessionEvent::Kind::kEnd, {}});
    if (first == 0xFF) events.push_back({time, SessionEvent::Kind::kReset, {}});
    if (first < 0xEE) events.push_back({time, SessionEvent::Kind::kData, test::as_vector(bytes)});
  }
  void half_close(Instant time) { note(time, "half-close"); }
  void close(Instant time) { note(time, "close"); }
  void reset(Instant time) { note(time, "reset"); }
  void advance_to(Instant /*time*/) {}
  [[nodiscard]] std::optional<Instant> next_event() const { return std::nullopt; }
  [[nodiscard]] std::span<const SessionEvent> sent() const { return events; }
  void clear_sent() { events.clear(); }
};

/// A bad connection to a recorder.
class ImpairedSessionTest : public ::testing::Test {
 protected:
  void open(std::string_view text) {
    const auto impairment = parse_impairment(text);
    ASSERT_TRUE(impairment) << describe(impairment.error());
    auto inner = std::make_unique<MemorySession<SessionRecorder>>(SessionRecorder{});
    server = &inner->device();
    port = std::make_unique<ImpairedSession>(std::move(inner), *impairment);
    ASSERT_TRUE(port->connect(at(1s)));
  }
  void send(std::string_view bytes) { EXPECT_TRUE(port->send(hex(bytes))) << bytes; }

  /// What a receive gave, as text with the time in milliseconds.
  std::string receive(Instant deadline) {
    ByteVector bytes(64);
    const auto received = port->receive(bytes, deadline);
    const auto time = std::to_string(microseconds(port->now()) / 1000) + " ";
    if (!received) return time + std::string{describe(received.error().code)};
    bytes.resize(received->size);
    switch (received->arrival) {
      case Arrival::kData:
        return time + to_hex(bytes);
      case Arrival::kDeadline:
        return time + "deadline";
      case Arrival::kEnd:
        return time + "end";
      case Arrival::kReset:
        return time + "reset";
    }
    return "";
  }
  [[nodiscard]] const std::vector<std::string>& notes() const { return server->notes; }

  SessionRecorder* server{};
  std::unique_ptr<ImpairedSession> port;
};

TEST_F(ImpairedSessionTest, WithoutDefectsIsThePortItself) {
  open("seed=1");
  send("01 02");
  EXPECT_EQ(receive(at(1s)), "0 0102");
  EXPECT_EQ(receive(at(5ms)), "5 deadline");
  port->close();
  EXPECT_THAT(notes(), ElementsAre("0 connect", "0 0102", "5 close"));
}

TEST_F(ImpairedSessionTest, DelaysBothWaysOnVirtualTime) {
  open("out.delay=2ms,in.delay=3ms");
  send("01");
  EXPECT_EQ(receive(at(1s)), "5 01");
  EXPECT_THAT(notes(), ElementsAre("0 connect", "2 01"));
}

TEST_F(ImpairedSessionTest, SendsEachPieceAsASegment) {
  open("out.split=2");
  send("01 02 03");
  EXPECT_THAT(notes(), ElementsAre("0 connect", "0 0102", "0 03"));
}

TEST_F(ImpairedSessionTest, SaysAnEndBehindWhatWasOnItsWayAndAgain) {
  open("in.delay=4ms");
  send("01");
  send("EE");
  EXPECT_EQ(receive(at(1s)), "4 01");
  EXPECT_EQ(receive(at(1s)), "4 end");
  EXPECT_EQ(receive(at(1s)), "4 end");
}

TEST_F(ImpairedSessionTest, SaysAResetOfTheServerAtOnce) {
  open("in.delay=4ms");
  send("01");
  EXPECT_EQ(receive(at(0ms)), "0 deadline");
  send("FF");
  EXPECT_EQ(receive(at(1s)), "0 reset");
  EXPECT_EQ(receive(at(1s)), "0 the other side has gone");
  EXPECT_EQ(port->statistics().in.bytes_cut_off, 1U);
}

TEST_F(ImpairedSessionTest, ResetsBothSidesWhenTheLinkBreaks) {
  open("out.disconnect-after=3");
  send("01 02");
  EXPECT_EQ(port->send(hex("03 04")).error().code, ErrorCode::kDisconnected);
  EXPECT_THAT(notes(), ElementsAre("0 connect", "0 0102", "0 03", "0 reset"));
  EXPECT_EQ(port->send(hex("05")).error().code, ErrorCode::kDisconnected);
  EXPECT_EQ(port->connect(at(1s)).error().code, ErrorCode::kBusy);
  EXPECT_EQ(receive(at(1s)), "0 reset");
  EXPECT_EQ(receive(at(1s)), "0 the other side has gone");
}

TEST_F(ImpairedSessionTest, ResetsBothSidesWhenTheWayBackBreaks) {
  open("in.disconnect-after=3");
  send("01 02 03 04");
  EXPECT_EQ(receive(at(1s)), "0 010203");
  EXPECT_EQ(receive(at(1s)), "0 reset");
  EXPECT_THAT(notes(), ElementsAre("0 connect", "0 01020304", "0 reset"));
}

TEST_F(ImpairedSessionTest, CountsBytesAnewOnEachConnection) {
  open("out.disconnect-after=3");
  EXPECT_FALSE(port->send(hex("01 02 03")));
  EXPECT_EQ(receive(at(1s)), "0 reset");
  ASSERT_TRUE(port->connect(at(1s)));
  send("04 05");
  EXPECT_EQ(port->statistics().out.disconnects, 1U);
  EXPECT_EQ(port->statistics().out.bytes_out, 5U);
}

TEST_F(ImpairedSessionTest, MayBeClosedInsteadOfReceivingTheReset) {
  open("out.disconnect=100%");
  EXPECT_FALSE(port->send(hex("01")));
  port->close();
  EXPECT_TRUE(port->connect(at(1s)));
}

TEST_F(ImpairedSessionTest, HalfClosesBehindWhatIsOnItsWay) {
  open("out.delay=5ms");
  send("01");
  port->half_close();
  EXPECT_EQ(port->send(hex("02")).error().code, ErrorCode::kDisconnected);
  EXPECT_EQ(receive(at(100ms)), "5 01");
  EXPECT_EQ(receive(at(100ms)), "100 deadline");
  EXPECT_THAT(notes(), ElementsAre("0 connect", "5 01", "5 half-close"));
}

TEST_F(ImpairedSessionTest, HalfClosesAtOnceIfNothingIsOnItsWay) {
  open("out.delay=5ms");
  port->half_close();
  EXPECT_THAT(notes(), ElementsAre("0 connect", "0 half-close"));
}

TEST_F(ImpairedSessionTest, HandsOverWhatIsOnItsWayBeforeItCloses) {
  open("out.delay=5ms");
  send("01");
  port->half_close();
  port->close();
  EXPECT_THAT(notes(), ElementsAre("0 connect", "0 01", "0 half-close", "0 close"));
}

TEST_F(ImpairedSessionTest, LosesWhatIsOnItsWayWhenItResets) {
  open("out.delay=5ms");
  send("01");
  port->reset();
  EXPECT_THAT(notes(), ElementsAre("0 connect", "0 reset"));
  EXPECT_EQ(port->statistics().out.bytes_cut_off, 1U);
  EXPECT_EQ(receive(at(1s)), "0 the other side has gone");
}

TEST_F(ImpairedSessionTest, RefusesToSendWithoutAConnection) {
  open("seed=1");
  port->close();
  EXPECT_EQ(port->send(hex("01")).error().code, ErrorCode::kDisconnected);
}

TEST_F(ImpairedSessionTest, RefusesASecondConnectionAndKeepsTheFirst) {
  open("delay=1ms");
  send("01");
  EXPECT_EQ(port->connect(at(1s)).error().code, ErrorCode::kBusy);
  EXPECT_EQ(receive(at(1s)), "2 01");
}

TEST(ImpairedSession, SpeaksToTheDemoServer) {
  const auto impairment = parse_impairment("in.split=1,in.bandwidth=1000");
  ASSERT_TRUE(impairment);
  ImpairedSession port{std::make_unique<MemorySession<demo::emulation::SessionDevice>>(
                           demo::emulation::SessionDevice{}),
                       *impairment};
  ASSERT_TRUE(port.connect(at(1s)));
  ByteVector greeting;
  ByteVector piece(64);
  for (int i = 0; i < 3; ++i) {
    const auto received = port.receive(piece, at(1s));
    ASSERT_TRUE(received && received->size == 1);
    greeting.push_back(piece[0]);
  }
  EXPECT_EQ(greeting, hex("5A 00 FF"));  // ready
  EXPECT_EQ(port.now(), at(3ms));
}

}  // namespace
}  // namespace armjig
