// SPDX-License-Identifier: Apache-2.0
#include "emulators/i2c/bus.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "emulators/i2c/thermometer.hpp"
#include "emulators/morap/defects/defects.hpp"
#include "emulators/morap/node.hpp"
#include "emulators/morap/pen.hpp"
#include "harness/link/emulated_bus_port.hpp"

namespace armjig::i2c {
namespace {

using namespace std::chrono_literals;
using enum BusPort::Access;
using Kind = Trouble::Kind;

constexpr BusAddress kNode{0x12};
constexpr BusAddress kSensor{0x48};

/// A node, a pen and a sensor, behind a port.
class MorapBus : public testing::Test {
 protected:
  MorapBus() : port_{make_bus()} {}

  static Bus make_bus() {
    Bus bus;
    bus.attach(morap::emulation::Node{{.eeprom = morap::emulation::dcx22l()}});
    bus.attach(morap::emulation::Pen{});
    Thermometer sensor{kSensor.value};
    sensor.set_temperature(-1.5);
    bus.attach(sensor);
    return bus;
  }
  morap::emulation::Node& node() { return port_.bus().device<morap::emulation::Node>(0); }

  /// Chooses a register and reads from it.
  std::vector<std::byte> read(BusAddress address, std::byte selector, std::size_t size) {
    std::vector<std::byte> bytes;
    EXPECT_EQ(port_.start(address, kWrite), Ack::kAck);
    EXPECT_EQ(port_.write(selector), Ack::kAck);
    EXPECT_EQ(port_.start(address, kRead), Ack::kAck);
    for (; size > 0; --size) bytes.push_back(*port_.read(size > 1 ? Ack::kAck : Ack::kNack));
    EXPECT_TRUE(port_.stop());
    return bytes;
  }
  std::byte status() { return read(kNode, std::byte{0x83}, 1).front(); }

  EmulatedBusPort<Bus> port_;
};

constexpr std::byte kNeedsCalibration{3};
constexpr std::byte kDisabled{2};
constexpr std::byte kCalibrate{0x10};

TEST(NamedDevices, GetTheInputsThatAreTheirs) {
  Bus bus;
  auto setup = morap::emulation::NodeSetup{.eeprom = morap::emulation::dcx22l()};
  const auto first = bus.attach(morap::emulation::DefectiveNode{setup, {}}, name_at(0x12));
  const auto second = bus.attach(morap::emulation::Pen{}, name_at(0x21));
  EXPECT_EQ(name_at(0x12), "0x12");
  EXPECT_EQ(std::pair(first, second), (std::pair<std::size_t, std::size_t>(0, 1)));
  EXPECT_TRUE(bus.set_input(at(1ms), "0x12.power", 1));
  EXPECT_TRUE(bus.set_input(at(1ms), "0x21.deploy", 1));
  EXPECT_TRUE(bus.set_input(at(1ms), "deploy", 1)) << "whoever has it";
  EXPECT_FALSE(bus.set_input(at(1ms), "0x12.deploy", 1)) << "a node has no such button";
  EXPECT_FALSE(bus.set_input(at(1ms), "0x13.power", 1)) << "nobody is there";
}

TEST_F(MorapBus, TakesAsLongAsItsBits) {
  const auto took = [this](auto transaction) {
    const auto begin = port_.now();
    transaction();
    return port_.now() - begin;
  };
  EXPECT_EQ(took([&] {
              EXPECT_EQ(port_.start({0x13}, kWrite), Ack::kNack);
              std::ignore = port_.stop();
            }),
            110us);
  EXPECT_EQ(took([&] {
              EXPECT_EQ(port_.start(kNode, kWrite), Ack::kAck);
              EXPECT_EQ(port_.write(kCalibrate), Ack::kAck);
              std::ignore = port_.stop();
            }),
            200us);
  EXPECT_EQ(took([&] { read(kNode, std::byte{0x80}, 4); }), 190us + 470us);
}

TEST_F(MorapBus, NobodyAnswersAtAbsentAndReservedAddresses) {
  for (std::uint8_t address = 0; address < 128; ++address) {
    const bool is_there = address == 0x12 || address == 0x19 || address == kSensor.value;
    EXPECT_EQ(port_.start({address}, kWrite), is_there ? Ack::kAck : Ack::kNack) << +address;
    std::ignore = port_.stop();
  }
}

TEST_F(MorapBus, CarriesAnyOtherDevice) {
  EXPECT_EQ(read(kSensor, std::byte{0}, 2), (std::vector{std::byte{0xFE}, std::byte{0x80}}));
  EXPECT_EQ(port_.start(kSensor, kWrite), Ack::kAck);
  EXPECT_EQ(port_.write(std::byte{2}), Ack::kAck);
  EXPECT_EQ(port_.write(std::byte{0x60}), Ack::kAck);
  EXPECT_EQ(port_.write(std::byte{0}), Ack::kNack) << "there is no register behind it";
  EXPECT_TRUE(port_.stop());
  EXPECT_EQ(read(kSensor, std::byte{2}, 1).front(), std::byte{0x60});
}

TEST_F(MorapBus, DevicesWithOneAddressAnswerTogether) {
  // Spec, bus vector B10: a zero bit wins.
  port_.bus().attach(morap::emulation::Node{{.eeprom = morap::emulation::dcx22l()}});
  node().turn_encoder(at(0ns), 1000);                                      // 8B 68 59 3D
  port_.bus().device<morap::emulation::Node>(3).turn_encoder(at(0ns), 1);  // 4D A0 5E 38
  const std::vector expected{std::byte{0x8B & 0x4D}, std::byte{0x68 & 0xA0}, std::byte{0x59 & 0x5E},
                             std::byte{0x3D & 0x38}};
  EXPECT_EQ(read(kNode, std::byte{0x80}, 4), expected);
}

TEST_F(MorapBus, AByteThatIsNotAcknowledgedDidNotArrive) {
  port_.bus().expect({.kind = Kind::kNack, .address = kNode.value, .byte = 1});
  EXPECT_EQ(port_.start(kNode, kWrite), Ack::kAck);
  EXPECT_EQ(port_.write(kCalibrate), Ack::kNack);
  EXPECT_TRUE(port_.stop());
  EXPECT_EQ(status(), kNeedsCalibration);
  port_.bus().expect({.kind = Kind::kNack});
  EXPECT_EQ(port_.start(kNode, kWrite), Ack::kNack) << "the address itself";
  EXPECT_TRUE(port_.stop());
}

TEST_F(MorapBus, LostArbitrationEndsTheTransaction) {
  port_.bus().expect({.kind = Kind::kArbitrationLost, .byte = 1});
  EXPECT_EQ(port_.start(kNode, kWrite), Ack::kAck);
  const auto lost = port_.write(kCalibrate);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, ErrorCode::kBusy);
  EXPECT_EQ(status(), kNeedsCalibration) << "the next one works, and the node saw nothing";
}

TEST_F(MorapBus, AStretchedClockIsWaitedForUntilPatienceEnds) {
  port_.bus().expect({.kind = Kind::kStretch, .byte = 1, .duration = 5ms});
  EXPECT_EQ(port_.start(kNode, kWrite), Ack::kAck);
  const auto before = port_.now();
  EXPECT_EQ(port_.write(kCalibrate), Ack::kAck);
  EXPECT_EQ(port_.now() - before, 90us + 5ms);
  EXPECT_TRUE(port_.stop());
  EXPECT_EQ(status(), kDisabled);

  port_.bus().expect({.kind = Kind::kStretch, .duration = 60ms});
  const auto stuck = port_.start(kNode, kWrite);
  ASSERT_FALSE(stuck);
  EXPECT_EQ(stuck.error().code, ErrorCode::kTimedOut);
  EXPECT_FALSE(port_.stop()) << "the clock is still held";
  port_.wait_until(port_.now() + 60ms);
  EXPECT_EQ(status(), kDisabled);
}

TEST_F(MorapBus, ADataLineHeldDownIsFreedByNineClocks) {
  port_.bus().expect({.kind = Kind::kDataHeld, .byte = 1, .clocks = 7});
  EXPECT_EQ(port_.start(kNode, kRead), Ack::kAck);
  EXPECT_TRUE(port_.read(Ack::kNack));
  EXPECT_FALSE(port_.stop());
  const auto held = port_.start(kNode, kWrite);
  ASSERT_FALSE(held);
  EXPECT_EQ(held.error().code, ErrorCode::kBusy);
  EXPECT_TRUE(port_.recover());
  EXPECT_EQ(status(), kNeedsCalibration);

  port_.bus().expect({.kind = Kind::kDataHeld, .clocks = 10});
  EXPECT_EQ(port_.start(kNode, kRead), Ack::kAck);
  EXPECT_FALSE(port_.recover()) << "nine are not enough for this one";
  EXPECT_TRUE(port_.recover());
}

TEST_F(MorapBus, ANodeThatRestartsInATransactionLetsGoOfIt) {
  EXPECT_EQ(port_.start(kNode, kWrite), Ack::kAck);
  EXPECT_EQ(port_.write(kCalibrate), Ack::kAck);
  EXPECT_TRUE(port_.stop());
  EXPECT_EQ(status(), kDisabled);
  port_.bus().expect({.kind = Kind::kDeviceRestarts, .byte = 2});
  EXPECT_EQ(port_.start(kNode, kWrite), Ack::kAck);
  EXPECT_EQ(port_.write(std::byte{0x01}), Ack::kAck);
  EXPECT_EQ(port_.write(std::byte{0x00}), Ack::kAck);
  EXPECT_EQ(port_.write(std::byte{0x00}), Ack::kNack);
  EXPECT_EQ(port_.read(Ack::kNack), std::byte{0xFF});
  EXPECT_TRUE(port_.stop());
  EXPECT_EQ(status(), kNeedsCalibration);
}

TEST_F(MorapBus, PowerIsOffAndOnForAllThatIsOnIt) {
  ASSERT_EQ(port_.start(kNode, kWrite), Ack::kAck);
  ASSERT_EQ(port_.write(kCalibrate), Ack::kAck);
  ASSERT_TRUE(port_.stop());
  EXPECT_EQ(status(), kDisabled);
  EXPECT_TRUE(port_.touch("power", 1));
  EXPECT_EQ(status(), kNeedsCalibration);
}

TEST_F(MorapBus, EffectsDoNotWaitForAStop) {
  EXPECT_EQ(port_.start(kNode, kWrite), Ack::kAck);
  EXPECT_EQ(port_.write(kCalibrate), Ack::kAck);
  EXPECT_EQ(node().status(), morap::MotorStatus::kDisabled);
}

TEST_F(MorapBus, TheTunerHoldsTheClockIfItIsToldTo) {
  Bus bus;
  bus.attach(morap::emulation::Node{{.eeprom = morap::emulation::dcx22l(), .tune_stretch = 1ms}});
  EmulatedBusPort port{bus};
  EXPECT_EQ(port.start(kNode, kWrite), Ack::kAck);
  for (const int byte : {0x22, 0, 0xCD, 0xCC, 0x4C, 0x3E, 0, 0, 0x10, 0xC1}) {
    EXPECT_EQ(port.write(static_cast<std::byte>(byte)), Ack::kAck);
  }
  EXPECT_EQ(port.now(), at(100us + 10 * 90us + 1ms));
}

TEST_F(MorapBus, CopyIsASnapshot) {
  auto copy = port_.bus();
  node().turn_encoder(port_.now(), 1000);
  EXPECT_EQ(copy.device<morap::emulation::Node>(0).angle(), 0.0F);
  EXPECT_NE(node().angle(), 0.0F);
}

TEST_F(MorapBus, ShowsThePenToWhoeverLooks) {
  EXPECT_EQ(port_.observe("servo"), 45);
  ASSERT_EQ(port_.start({morap::pen::kAddress}, kWrite), Ack::kAck);
  ASSERT_EQ(port_.write(std::byte{1}), Ack::kAck);
  ASSERT_TRUE(port_.stop());
  EXPECT_EQ(port_.observe("servo"), 8);
  EXPECT_EQ(port_.observe("lamp1"), 1);
  EXPECT_EQ(port_.observe("lamp2"), 1);
  EXPECT_EQ(port_.observe("lamp3"), std::nullopt);
  ASSERT_TRUE(port_.touch("pen-power", 1));
  EXPECT_EQ(port_.observe("servo"), 45);
}

}  // namespace
}  // namespace armjig::i2c
