// SPDX-License-Identifier: Apache-2.0
// The adapter's side of the control transfers is played here: it is what a machine without one can
// have (docs/limits.md).
#include "harness/link/i2c_tiny_usb.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "emulators/i2c/bus.hpp"
#include "emulators/morap/node.hpp"
#include "harness/drive/morap/joint.hpp"

namespace armjig {
namespace {

using ::testing::ElementsAre;

/// An adapter with a bus, as seen by control transfers. It notes the request of each message.
class Adapter final : public UsbControl {
 public:
  struct Behaviour {
    std::byte functions{0x01};
    std::optional<ErrorCode> trouble{};  ///< of everything but the first two requests
    bool is_cut_short = false;           ///< takes and gives one byte less than it should
  };
  struct Log {
    std::vector<int> requests;
    std::optional<std::uint16_t> delay;
  };

  Adapter(Behaviour behaviour, std::shared_ptr<Log> log)
      : behaviour_{behaviour}, log_{std::move(log)} {
    bus_.attach(morap::Node{{.eeprom = morap::dcx22l()}});
  }

  Result<std::size_t> read(UsbRequest request, std::span<std::byte> into) override {
    if (request.request == 1) {
      std::ranges::fill(into, std::byte{});
      into[0] = behaviour_.functions;
      return into.size();
    }
    if (behaviour_.trouble) return fail(*behaviour_.trouble);
    if (request.request == 3) {
      into[0] = status_;
      return 1;
    }
    if (!begin(request, /*is_read=*/true)) return 0;
    for (auto& byte : into) {
      const auto reply = bus_.read(time_);
      time_ = reply.end;
      byte = reply.byte;
    }
    end(request);
    return into.size() - (behaviour_.is_cut_short ? 1 : 0);
  }

  Result<std::size_t> write(UsbRequest request, Bytes bytes) override {
    if (request.request == 2) {
      log_->delay = request.value;
      return 0;
    }
    if (behaviour_.trouble) return fail(*behaviour_.trouble);
    if (!begin(request, /*is_read=*/false)) return 0;
    for (const auto byte : bytes) time_ = bus_.write(time_, byte).end;
    end(request);
    return bytes.size() - (behaviour_.is_cut_short ? 1 : 0);
  }

 private:
  bool begin(UsbRequest request, bool is_read) {
    log_->requests.push_back(request.request);
    EXPECT_EQ(request.value, is_read ? 1 : 0);
    const auto reply = bus_.start(time_, static_cast<std::uint8_t>(request.index), is_read);
    time_ = reply.end;
    const bool is_there = reply.outcome == BusReply::Outcome::kAck;
    status_ = std::byte{is_there ? std::uint8_t{1} : std::uint8_t{2}};
    return is_there;
  }
  void end(UsbRequest request) {
    if ((request.request & 2) != 0) time_ = bus_.stop(time_).end;
  }

  Behaviour behaviour_;
  std::shared_ptr<Log> log_;
  i2c::Bus bus_;
  Instant time_{};
  std::byte status_{};
};

struct Plugged {
  explicit Plugged(Adapter::Behaviour behaviour = {}) {
    auto made = make_i2c_tiny_usb(std::make_unique<Adapter>(behaviour, log), "i2c-tiny-usb:");
    if (made) port = *std::move(made);
    if (!made) problem = made.error();
  }
  std::shared_ptr<Adapter::Log> log = std::make_shared<Adapter::Log>();
  std::unique_ptr<BusPort> port;
  std::optional<Problem> problem;
};

constexpr BusAddress kNode{0x12};
constexpr BusAddress kNobody{0x13};

TEST(I2cTinyUsb, CarriesWhatADriveSaysAndHears) {
  const Plugged plugged;
  morap::Master master{*plugged.port};
  morap::Joint joint{master, kNode};
  EXPECT_EQ(joint.calibrate(morap::Angle{1.0F}), morap::BusCode::kOk);
  // captures/morap: 1 rad is 18840 counts, which read as 0.9999935
  EXPECT_FLOAT_EQ(joint.angle().value.value, 0.9999935F);
  EXPECT_EQ(joint.own_address().value, 0x12);
}

TEST(I2cTinyUsb, SetsTheClockToAtMost100KilohertzFirst) { EXPECT_EQ(Plugged{}.log->delay, 5); }

TEST(I2cTinyUsb, BeginsEachMessageAndEndsTheLast) {
  const Plugged plugged;
  const std::array select{std::byte{0x88}};
  std::array<std::byte, 1> answer{};
  const std::array messages{write_to(kNode, select), read_from(kNode, answer)};
  EXPECT_EQ(plugged.port->transfer(messages), Transfer::kDone);
  EXPECT_THAT(plugged.log->requests, ElementsAre(4 | 1, 4 | 1 | 2));
  EXPECT_EQ(answer[0], std::byte{0x12});
}

TEST(I2cTinyUsb, TellsWhoIsNotThere) {
  const Plugged plugged;
  const auto poke = write_to(kNobody, {});
  EXPECT_EQ(plugged.port->transfer({&poke, 1}), Transfer::kAddressRefused);
}

TEST(I2cTinyUsb, AShortTransferIsARefusedByte) {
  const Plugged plugged{{.is_cut_short = true}};
  std::array<std::byte, 4> answer{};
  const auto read = read_from(kNode, answer);
  EXPECT_EQ(plugged.port->transfer({&read, 1}), Transfer::kByteRefused);
}

TEST(I2cTinyUsb, SaysThatItWasPulledOut) {
  const Plugged plugged{{.trouble = ErrorCode::kDisconnected}};
  const auto poke = write_to(kNode, {});
  EXPECT_EQ(plugged.port->transfer({&poke, 1}).error().code, ErrorCode::kDisconnected);
  morap::Master master{*plugged.port};
  EXPECT_EQ(master.poke(kNode), morap::BusCode::kGone);
}

TEST(I2cTinyUsb, RefusesADeviceThatIsNoSuchAdapter) {
  const Plugged plugged{{.functions = std::byte{}}};
  ASSERT_TRUE(plugged.problem);
  EXPECT_EQ(plugged.problem->code, ErrorCode::kUnsupported);
}

TEST(I2cTinyUsb, CannotBeLedByteByByte) {
  const Plugged plugged;
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
