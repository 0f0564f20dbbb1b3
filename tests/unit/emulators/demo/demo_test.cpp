// SPDX-License-Identifier: Apache-2.0
// The demo device on each of the three ports, all in memory and on virtual time.
#include "emulators/demo/demo.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "emulators/memory/in_memory.hpp"
#include "harness/link/memory_session.hpp"
#include "harness/link/memory_stream.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig::demo::emulation {
namespace {

using test::ByteVector;
using test::hex;
using namespace std::chrono_literals;

// A request is A5 op ~op, a reply 5A state ~state.
const auto kQueryBytes = hex("A5 71 8E");
const auto kStartBytes = hex("A5 73 8C");
const auto kHaltBytes = hex("A5 68 97");
const auto kReadyReply = hex("5A 00 FF");
const auto kRunningReply = hex("5A 01 FE");
const auto kHaltedReply = hex("5A 02 FD");
const auto kUnknownReply = hex("5A EE 11");

TEST(DemoMachine, HasANextStateForEveryOperation) {
  const auto after = [](std::initializer_list<Operation> operations) {
    Machine machine;
    State state{};
    for (const auto operation : operations) state = machine.act(operation);
    return state;
  };
  using enum Operation;
  EXPECT_EQ(after({kQuery}), State::kReady);
  EXPECT_EQ(after({kStart}), State::kRunning);
  EXPECT_EQ(after({kHalt}), State::kHalted);
  EXPECT_EQ(after({kStart, kQuery}), State::kRunning);
  EXPECT_EQ(after({kStart, kStart}), State::kRunning);
  EXPECT_EQ(after({kStart, kHalt}), State::kHalted);
  EXPECT_EQ(after({kHalt, kQuery}), State::kHalted);
  EXPECT_EQ(after({kHalt, kStart}), State::kRunning);
  EXPECT_EQ(after({kHalt, kHalt}), State::kHalted);
}

TEST(DemoMachine, KeepsItsStateAtAnUnknownOperation) {
  Machine machine;
  machine.act(Operation::kStart);
  EXPECT_EQ(machine.act(Operation{'?'}), State::kUnknownOperation);
  EXPECT_EQ(machine.act(Operation::kQuery), State::kRunning);
}

class DemoOnAStream : public testing::Test {
 protected:
  ByteVector read_until(Instant deadline) {
    ByteVector all;
    std::array<std::byte, 2> piece{};
    while (const auto size = *stream_.read(piece, deadline)) {
      all.insert(all.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(size));
    }
    return all;
  }
  MemoryStream<StreamDevice> stream_{StreamDevice{}};
};

TEST_F(DemoOnAStream, RepliesAMillisecondAfterTheLastByte) {
  ASSERT_TRUE(stream_.write(kStartBytes));
  std::array<std::byte, 8> reply{};
  ASSERT_EQ(stream_.read(reply, at(999us)), 0U);
  EXPECT_EQ(stream_.now(), at(999us));
  ASSERT_EQ(stream_.read(reply, at(1s)), 3U);
  EXPECT_EQ(stream_.now(), at(1ms));
  EXPECT_TRUE(test::same_bytes(Bytes{reply}.first(3), kRunningReply));
}

TEST_F(DemoOnAStream, RepliesToEveryRequestInOrder) {
  ASSERT_TRUE(stream_.write(test::joined(kQueryBytes, kStartBytes, kHaltBytes, hex("A5 3F C0"))));
  EXPECT_TRUE(test::same_bytes(
      read_until(at(1s)), test::joined(kReadyReply, kRunningReply, kHaltedReply, kUnknownReply)));
}

TEST_F(DemoOnAStream, FindsARequestBehindADamagedOne) {
  for (const auto* damage : {"00", "A5", "A5 A5", "A5 73", "A5 73 8D", "A5 A5 5A A5"}) {
    ASSERT_TRUE(stream_.write(test::joined(hex(damage), kQueryBytes)));
    const auto reply = read_until(stream_.now() + 1s);
    ASSERT_GE(reply.size(), 3U) << damage;
    EXPECT_TRUE(test::same_bytes(Bytes{reply}.last(3), kReadyReply)) << damage;
  }
}

TEST_F(DemoOnAStream, TakesBytesOneAtATime) {
  for (const auto byte : kStartBytes) {
    EXPECT_TRUE(read_until(stream_.now() + 1ms).empty());
    ASSERT_TRUE(stream_.write(std::array{byte}));
  }
  EXPECT_TRUE(test::same_bytes(read_until(stream_.now() + 1s), kRunningReply));
}

class DemoOnASession : public testing::Test {
 protected:
  using Arrival = SessionPort::Arrival;

  /// What comes next within a second of virtual time.
  Arrival next(ByteVector* data = nullptr) {
    std::array<std::byte, 16> bytes{};
    const auto received = port_.receive(bytes, port_.now() + 1s);
    EXPECT_TRUE(received);
    if (data != nullptr) *data = test::as_vector(Bytes{bytes}.first(received->size));
    return received->arrival;
  }
  MemorySession<SessionDevice> port_{SessionDevice{}};
};

TEST_F(DemoOnASession, GreetsAndReplies) {
  ByteVector data;
  ASSERT_TRUE(port_.connect(at(1s)));
  EXPECT_EQ(next(&data), Arrival::kData);
  EXPECT_TRUE(test::same_bytes(data, kReadyReply));
  ASSERT_TRUE(port_.send(kStartBytes));
  EXPECT_EQ(next(&data), Arrival::kData);
  EXPECT_TRUE(test::same_bytes(data, kRunningReply));
  EXPECT_EQ(port_.now(), at(1ms));
  EXPECT_EQ(next(), Arrival::kDeadline);
}

TEST_F(DemoOnASession, EndsAConnectionThatEnds) {
  ASSERT_TRUE(port_.connect(at(1s)));
  EXPECT_EQ(next(), Arrival::kData);
  port_.half_close();
  EXPECT_EQ(next(), Arrival::kEnd);
}

TEST_F(DemoOnASession, ThrowsAwayAConnectionThatSendsZero) {
  ASSERT_TRUE(port_.connect(at(1s)));
  EXPECT_EQ(next(), Arrival::kData);
  ASSERT_TRUE(port_.send(hex("00")));
  EXPECT_EQ(next(), Arrival::kReset);
  EXPECT_EQ(port_.send(kQueryBytes), fail(ErrorCode::kDisconnected));
}

TEST_F(DemoOnASession, TakesOneConnectionAtATime) {
  ASSERT_TRUE(port_.connect(at(1s)));
  EXPECT_EQ(port_.connect(at(1s)), fail(ErrorCode::kBusy));
  port_.close();
  EXPECT_TRUE(port_.connect(at(1s)));
}

TEST_F(DemoOnASession, ForgetsItsStateWithTheConnection) {
  ByteVector data;
  ASSERT_TRUE(port_.connect(at(1s)));
  ASSERT_TRUE(port_.send(kStartBytes));
  port_.reset();
  ASSERT_TRUE(port_.connect(at(1s)));
  EXPECT_EQ(next(&data), Arrival::kData);
  EXPECT_TRUE(test::same_bytes(data, kReadyReply));
  EXPECT_EQ(next(), Arrival::kDeadline) << "nothing of the old connection comes";
}

class DemoOnABus : public testing::Test {
 protected:
  static constexpr BusAddress kAddress{BusDevice::kAddress};
  std::unique_ptr<BusPort> port_ = open_in_memory(make_hosted(BusDevice{}));
  BusPort& bus_ = *port_;
};

TEST_F(DemoOnABus, TakesAnOperationAndTellsItsState) {
  EXPECT_EQ(bus_.start(kAddress, BusPort::Access::kWrite), Ack::kAck);
  EXPECT_EQ(bus_.write(std::byte{'s'}), Ack::kAck);
  EXPECT_EQ(bus_.start(kAddress, BusPort::Access::kRead), Ack::kAck);
  EXPECT_EQ(bus_.read(Ack::kNack), std::byte{0x01});
  EXPECT_TRUE(bus_.stop());
}

TEST_F(DemoOnABus, RefusesAnOperationThatItDoesNotKnow) {
  EXPECT_EQ(bus_.start(kAddress, BusPort::Access::kWrite), Ack::kAck);
  EXPECT_EQ(bus_.write(std::byte{'?'}), Ack::kNack);
  EXPECT_EQ(bus_.start(kAddress, BusPort::Access::kRead), Ack::kAck);
  EXPECT_EQ(bus_.read(Ack::kNack), std::byte{0xEE});
}

TEST_F(DemoOnABus, DoesNotAnswerToAnotherAddress) {
  EXPECT_EQ(bus_.start(BusAddress{0x2B}, BusPort::Access::kWrite), Ack::kNack);
  EXPECT_EQ(bus_.write(std::byte{'s'}), Ack::kNack);
  EXPECT_EQ(bus_.read(Ack::kNack), std::byte{0xFF}) << "an idle line";
}

TEST_F(DemoOnABus, IsSilentBetweenStopAndStart) {
  EXPECT_EQ(bus_.start(kAddress, BusPort::Access::kWrite), Ack::kAck);
  EXPECT_TRUE(bus_.stop());
  EXPECT_EQ(bus_.write(std::byte{'s'}), Ack::kNack);
}

TEST_F(DemoOnABus, TakesAsLongAsItsBits) {
  // 100 kHz: start 1 bit, each byte with its acknowledge 9, stop 1.
  EXPECT_EQ(bus_.start(kAddress, BusPort::Access::kWrite), Ack::kAck);
  EXPECT_EQ(bus_.now(), at(100us));
  EXPECT_EQ(bus_.write(std::byte{'q'}), Ack::kAck);
  EXPECT_EQ(bus_.now(), at(190us));
  EXPECT_TRUE(bus_.stop());
  EXPECT_EQ(bus_.now(), at(200us));
  bus_.wait_until(at(1ms));
  EXPECT_EQ(bus_.now(), at(1ms));
}

}  // namespace
}  // namespace armjig::demo::emulation
