// SPDX-License-Identifier: Apache-2.0
// Below control transfers there is no USB here; tests/testbed has that.
#include "harness/link/i2c_tiny_usb.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>

#include "harness/drive/morap/joint.hpp"
#include "tests/unit/link/tiny_usb_adapter.hpp"

namespace armjig {
namespace {

using ::testing::ElementsAre;

struct PluggedAdapter {
  explicit PluggedAdapter(TinyUsbAdapter::Behaviour behaviour = {}) {
    auto made =
        make_i2c_tiny_usb(std::make_unique<TinyUsbAdapter>(behaviour, log), "i2c-tiny-usb:");
    if (made) port = *std::move(made);
    if (!made) problem = made.error();
  }
  std::shared_ptr<TinyUsbAdapter::Log> log = std::make_shared<TinyUsbAdapter::Log>();
  std::unique_ptr<BusPort> port;
  std::optional<Problem> problem;
};

constexpr BusAddress kNode{0x12};
constexpr BusAddress kNobody{0x13};

TEST(I2cTinyUsb, CarriesWhatADriveSaysAndHears) {
  const PluggedAdapter plugged;
  morap::drive::Master master{*plugged.port};
  morap::drive::Joint joint{master, kNode};
  EXPECT_EQ(joint.calibrate(morap::drive::Angle{1.0F}), morap::drive::BusCode::kOk);
  // captures/morap: 1 rad is 18840 counts, which read as 0.9999935
  EXPECT_FLOAT_EQ(joint.angle().value.value, 0.9999935F);
  EXPECT_EQ(joint.own_address().value, 0x12);
}

TEST(I2cTinyUsb, SetsTheClockToAtMost100KilohertzFirst) {
  EXPECT_EQ(PluggedAdapter{}.log->delay, 5);
}

TEST(I2cTinyUsb, BeginsEachMessageAndEndsTheLast) {
  const PluggedAdapter plugged;
  const std::array select{std::byte{0x88}};
  std::array<std::byte, 1> answer{};
  const std::array messages{write_to(kNode, select), read_from(kNode, answer)};
  EXPECT_EQ(plugged.port->transfer(messages), Transfer::kDone);
  EXPECT_THAT(plugged.log->requests, ElementsAre(4 | 1, 4 | 1 | 2));
  EXPECT_EQ(answer[0], std::byte{0x12});
}

TEST(I2cTinyUsb, TellsWhoIsNotThere) {
  const PluggedAdapter plugged;
  const auto poke = write_to(kNobody, {});
  EXPECT_EQ(plugged.port->transfer({&poke, 1}), Transfer::kAddressRefused);
}

TEST(I2cTinyUsb, AShortTransferIsARefusedByte) {
  const PluggedAdapter plugged{{.is_cut_short = true}};
  std::array<std::byte, 4> answer{};
  const auto read = read_from(kNode, answer);
  EXPECT_EQ(plugged.port->transfer({&read, 1}), Transfer::kByteRefused);
}

TEST(I2cTinyUsb, SaysThatItWasPulledOut) {
  const PluggedAdapter plugged{{.trouble = ErrorCode::kDisconnected}};
  const auto poke = write_to(kNode, {});
  EXPECT_EQ(plugged.port->transfer({&poke, 1}).error().code, ErrorCode::kDisconnected);
  morap::drive::Master master{*plugged.port};
  EXPECT_EQ(master.poke(kNode), morap::drive::BusCode::kGone);
}

TEST(I2cTinyUsb, RefusesADeviceThatIsNoSuchAdapter) {
  const PluggedAdapter plugged{{.functions = std::byte{}}};
  ASSERT_TRUE(plugged.problem);
  EXPECT_EQ(plugged.problem->code, ErrorCode::kUnsupported);
}

TEST(I2cTinyUsb, CannotBeLedByteByByte) {
  const PluggedAdapter plugged;
  EXPECT_FALSE(plugged.port->has_operations());
  EXPECT_EQ(plugged.port->start(kNode, Access::kWrite).error().code, ErrorCode::kUnsupported);
}

TEST(I2cTinyUsb, IsNotFoundWhereNoneIsPluggedIn) {
  const auto port = open_i2c_tiny_usb("no such serial number");
  ASSERT_FALSE(port);
  EXPECT_NE(port.error().code, ErrorCode::kBadTarget);
}

}  // namespace
}  // namespace armjig
