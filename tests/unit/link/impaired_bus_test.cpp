// SPDX-License-Identifier: Apache-2.0
#include "harness/link/impaired_bus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "emulators/demo/demo.hpp"
#include "emulators/i2c/bus.hpp"
#include "harness/core/hex.hpp"
#include "harness/link/emulated_bus_port.hpp"
#include "harness/link/transaction_bus.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Access = BusPort::Access;

constexpr BusAddress kDemo{demo::emulation::BusDevice::kAddress};

/// A device that notes what is written and reads as 1, 2, 3, ...
struct BusRecorder {
  std::vector<int> written;
  int reads = 0;

  [[nodiscard]] bool acknowledges(std::uint8_t address) const {
    return address == demo::emulation::BusDevice::kAddress;
  }
  [[nodiscard]] bool write(Instant /*time*/, std::byte byte) {
    written.push_back(std::to_integer<int>(byte));
    return true;
  }
  [[nodiscard]] std::byte read(Instant /*time*/) { return static_cast<std::byte>(++reads); }
};

std::unique_ptr<EmulatedBusPort<i2c::Bus>> make_bus() {
  i2c::Bus bus;
  bus.attach(BusRecorder{});
  return std::make_unique<EmulatedBusPort<i2c::Bus>>(std::move(bus));
}

struct Bus {
  explicit Bus(std::string_view text) {
    const auto impairment = parse_impairment(text);
    auto inner = make_bus();
    device = &inner->bus().device<BusRecorder>(0);
    auto made = ImpairedBus::make(std::move(inner), impairment.value());
    if (!made) ADD_FAILURE() << describe(made.error());
    port = std::move(made.value());
  }
  BusRecorder* device{};
  std::unique_ptr<ImpairedBus> port;
};

TEST(ImpairedBus, WithoutDefectsIsThePortItself) {
  const Bus bus{"seed=1"};
  EXPECT_EQ(bus.port->start(kDemo, Access::kWrite), Ack::kAck);
  EXPECT_EQ(bus.port->write(std::byte{5}), Ack::kAck);
  EXPECT_EQ(bus.port->start(kDemo, Access::kRead), Ack::kAck);
  EXPECT_EQ(bus.port->read(Ack::kNack), std::byte{1});
  EXPECT_TRUE(bus.port->stop());
  EXPECT_THAT(bus.device->written, ElementsAre(5));
  EXPECT_EQ(bus.port->now(), at(390us));  // two starts, four bytes of nine clocks, a stop
}

TEST(ImpairedBus, MissesEverythingAfterAMissedAddress) {
  const Bus bus{"out.loss=100%"};
  EXPECT_EQ(bus.port->start(kDemo, Access::kWrite), Ack::kNack);
  EXPECT_EQ(bus.port->write(std::byte{5}), Ack::kNack);
  EXPECT_EQ(bus.port->read(Ack::kNack), std::byte{0xFF});
  EXPECT_TRUE(bus.port->stop());
  EXPECT_THAT(bus.device->written, IsEmpty());
  EXPECT_EQ(bus.device->reads, 0);
  EXPECT_EQ(bus.port->now(), at(270us));  // three bytes that nobody saw
  EXPECT_EQ(bus.port->statistics().out.chunks_lost, 1U);
}

TEST(ImpairedBus, RefusesEachByteThatTheDeviceMisses) {
  const Bus bus{"out.loss=30%,seed=3"};
  std::vector<int> acknowledged;
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    if (bus.port->start(kDemo, Access::kWrite) != Ack::kAck) {
      ++refused;
      continue;
    }
    const bool is_taken = bus.port->write(static_cast<std::byte>(i)) == Ack::kAck;
    if (is_taken) acknowledged.push_back(i);
    refused += is_taken ? 0 : 1;
  }
  EXPECT_EQ(bus.device->written, acknowledged);
  EXPECT_EQ(bus.port->statistics().out.chunks_lost, static_cast<unsigned>(refused));
  EXPECT_GT(refused, 50);
}

TEST(ImpairedBus, ReadsALostByteAsAnIdleLine) {
  const Bus bus{"in.loss=100%"};
  EXPECT_EQ(bus.port->start(kDemo, Access::kRead), Ack::kAck);
  EXPECT_EQ(bus.port->read(Ack::kAck), std::byte{0xFF});
  EXPECT_EQ(bus.device->reads, 1) << "the device did send it";
  EXPECT_EQ(bus.port->now(), at(190us));
}

TEST(ImpairedBus, FlipsBitsOfDataBothWays) {
  const Bus bus{"in.bit-errors=100%"};
  EXPECT_EQ(bus.port->start(kDemo, Access::kRead), Ack::kAck);
  EXPECT_EQ(bus.port->read(Ack::kAck), std::byte{0xFE});
  EXPECT_EQ(bus.port->statistics().in.bits_flipped, 8U);
}

TEST(ImpairedBus, NeverMeansAnotherDevice) {
  const Bus bus{"out.bit-errors=100%"};
  // 0x55 with all bits flipped is 0x2A, the demo device.
  EXPECT_EQ(bus.port->start(BusAddress{0x55}, Access::kWrite), Ack::kNack);
  EXPECT_EQ(bus.port->start(kDemo, Access::kWrite), Ack::kNack);
}

TEST(ImpairedBus, StretchesTheClockToDelay) {
  const Bus bus{"out.delay=1ms,in.delay=2ms"};
  std::ignore = bus.port->start(kDemo, Access::kRead);
  std::ignore = bus.port->read(Ack::kNack);
  EXPECT_EQ(bus.port->now(), at(3190us));  // 1 ms, start and address, the byte, 2 ms
}

TEST(ImpairedBus, FindsNobodyAfterADisconnect) {
  const Bus bus{"in.disconnect-after=1"};
  EXPECT_EQ(bus.port->start(kDemo, Access::kRead), Ack::kAck);
  EXPECT_EQ(bus.port->read(Ack::kAck), std::byte{1});
  EXPECT_EQ(bus.port->read(Ack::kAck), std::byte{0xFF});
  EXPECT_TRUE(bus.port->stop());
  EXPECT_EQ(bus.port->start(kDemo, Access::kWrite), Ack::kNack);
  EXPECT_EQ(bus.device->reads, 1);
}

/// A bus as Linux has it; notes what reaches it, and reads as ones and zeros.
class Adapter final : public TransactionBus {
 public:
  explicit Adapter(std::vector<std::string>& notes) : notes_{notes} {}
  Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    for (const auto& message : messages) {
      std::ranges::fill(message.read, std::byte{0xAA});
      notes_.push_back(to_hex(std::array{head_of(message)}) + ":" + to_hex(message.write));
    }
    return Transfer::kDone;
  }
  void wait_until(Instant time) override { now_ = std::max(now_, time); }
  [[nodiscard]] Instant now() const override { return now_; }

 private:
  std::vector<std::string>& notes_;
  Instant now_{};
};

class ImpairedAdapter : public testing::Test {
 protected:
  /// Writes two bytes and reads two.
  Result<Transfer> transfer(std::string_view impairment) {
    auto inner = std::make_unique<Adapter>(notes);
    port = std::move(
        ImpairedBus::make(std::move(inner), parse_impairment(impairment).value()).value());
    constexpr std::array kTwo{std::byte{1}, std::byte{2}};
    return port->transfer(std::array{write_to(kDemo, kTwo), read_from(kDemo, value)});
  }
  std::vector<std::string> notes;
  std::array<std::byte, 2> value{};
  std::unique_ptr<ImpairedBus> port;
};

TEST_F(ImpairedAdapter, GetsATransactionInOnePiece) {
  EXPECT_EQ(transfer("out.delay=1ms,in.delay=2ms"), Transfer::kDone);
  EXPECT_FALSE(port->has_operations());
  EXPECT_THAT(notes, ElementsAre("54:0102", "55:"));
  EXPECT_THAT(value, ElementsAre(std::byte{0xAA}, std::byte{0xAA}));
  EXPECT_EQ(port->now(), at(8ms));  // four bytes out, two in
}

TEST_F(ImpairedAdapter, GetsNothingBehindAMissedAddress) {
  EXPECT_EQ(transfer("out.loss=100%"), Transfer::kAddressRefused);
  EXPECT_THAT(notes, IsEmpty());
}

TEST_F(ImpairedAdapter, GetsWhatCameBeforeALostByte) {
  EXPECT_EQ(transfer("out.disconnect-after=2"), Transfer::kByteRefused);
  EXPECT_THAT(notes, ElementsAre("54:01"));
  EXPECT_EQ(port->transfer({}), Transfer::kDone) << "of nothing, nothing is lost";
}

TEST_F(ImpairedAdapter, ReadsLostBytesAsAnIdleLineAndFlippedOnesFlipped) {
  EXPECT_EQ(transfer("in.loss=100%"), Transfer::kDone);
  EXPECT_THAT(value, ElementsAre(std::byte{0xFF}, std::byte{0xFF}));
  EXPECT_EQ(transfer("in.bit-errors=100%"), Transfer::kDone);
  EXPECT_THAT(value, ElementsAre(std::byte{0x55}, std::byte{0x55}));
}

TEST(ImpairedBus, RefusesWhatABusCannotHave) {
  const auto impairment = parse_impairment("loss=1%,out.split=random,double=2%,seed=9");
  ASSERT_TRUE(impairment);
  const auto made = ImpairedBus::make(make_bus(), *impairment);
  ASSERT_FALSE(made);
  EXPECT_EQ(describe(made.error()),
            "impairment 'double=2%,out.split=random': not supported here; an I2C bus can have "
            "bit-errors, loss, delay, bandwidth, stall, disconnect and disconnect-after");
}

}  // namespace
}  // namespace armjig
