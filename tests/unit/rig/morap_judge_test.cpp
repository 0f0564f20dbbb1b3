// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/morap_judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "emulators/i2c/bus.hpp"
#include "emulators/morap/node.hpp"
#include "harness/core/hex.hpp"
#include "harness/link/emulated_bus_port.hpp"
#include "harness/rig/guarded_ports.hpp"

namespace armjig::morap::rig {
namespace {

constexpr BusAddress kNode{0x12};
constexpr BusAddress kPen{0x19};
constexpr BusAddress kSensor{0x68};

class MorapJudge : public testing::Test {
 protected:
  bool lets(BusAddress address, std::string_view hex, std::string_view allowed) {
    auto message = message_of(address, Access::kWrite);
    const auto bytes = from_hex(hex).value();
    message.insert(message.end(), bytes.begin(), bytes.end());
    const bool is_let = !judge_->judge(message, parse_permissions(allowed).value());
    if (is_let) judge_->observe(message);  // the device acknowledges it
    return is_let;
  }
  static std::vector<std::byte> message_of(BusAddress address, Access access) {
    return {head_of({address, access})};
  }
  std::unique_ptr<Judge> judge_ = make_judge();
};

TEST_F(MorapJudge, LetsAnybodyLookAndStop) {
  for (const auto* harmless : {"", "80", "8A", "00", "1F", "06", "0E", "01 00 00"}) {
    EXPECT_TRUE(lets(kNode, harmless, "")) << harmless;
  }
  EXPECT_FALSE(judge_->judge(message_of(kNode, Access::kRead), {}));
}

TEST_F(MorapJudge, AsksForMoveBeforeReferences) {
  for (const auto* reference :
       {"01 00 00 80 3F", "02 00 00 80 3F", "03 00 00 80 3F", "04 00 00 80 3F", "05 00 00 80 3F"}) {
    EXPECT_FALSE(lets(kNode, reference, "state")) << reference;
    EXPECT_TRUE(lets(kNode, reference, "move")) << reference;
  }
}

TEST_F(MorapJudge, TakesCalibrationForMotionUnlessTheNodeIsKnownToStand) {
  EXPECT_FALSE(lets(kNode, "10", "state"));
  EXPECT_TRUE(lets(kNode, "00", ""));
  EXPECT_TRUE(lets(kNode, "10", "state"));
  EXPECT_TRUE(lets(kNode, "01 00 00 80 3F", "move"));
  EXPECT_FALSE(lets(kNode, "11 00 00 80 3F", "state"));
}

TEST_F(MorapJudge, AsksForProgramBeforeProgrammingANodeThatStands) {
  constexpr auto kTune = "22 00 CD CC 4C 3E 00 00 10 C1";
  EXPECT_FALSE(lets(kNode, kTune, "program"));
  EXPECT_TRUE(lets(kNode, "00", ""));
  EXPECT_FALSE(lets(kNode, kTune, "state"));
  EXPECT_TRUE(lets(kNode, kTune, "program"));
  EXPECT_TRUE(lets(kNode, "21", "program"));
  EXPECT_FALSE(lets(kNode, "20 00 01", "")) << "cut short it still changes the status";
}

TEST_F(MorapJudge, NeverLetsWhatBreaksTheFirmware) {
  EXPECT_TRUE(lets(kNode, "00", ""));
  const std::vector<std::string_view> dangers{
      "01 00 00 80 3F 00",                    // behind the number
      "11 00 00 80 3F 00",                    // the same, of an angle
      "01 00 00 C0 7F",                       // no number
      "03 00 00 80 7F",                       // infinite
      "20 00 C8 00 00 00 00 00 00 00 00 37",  // filters without coefficients
      "22 00 00 00 00 00 00 00 10 C1",        // no inertia
  };
  for (const auto danger : dangers) EXPECT_FALSE(lets(kNode, danger, "all")) << danger;
  auto endless = message_of(kNode, Access::kWrite);
  endless.resize(1 + 256, std::byte{0xFE});
  EXPECT_TRUE(judge_->judge(endless, Permissions::all()));
}

TEST_F(MorapJudge, NeverLetsWhatHangsThePen) {
  EXPECT_FALSE(lets(kPen, "01", "state,move"));
  EXPECT_TRUE(lets(kPen, "01", "grip"));
  EXPECT_TRUE(lets(kPen, "07 80", "grip"));
  EXPECT_TRUE(lets(kPen, "", ""));
  EXPECT_FALSE(lets(kPen, "01 00", "all"));
  EXPECT_FALSE(lets(kPen, "07 80 00", "all"));
  EXPECT_TRUE(judge_->judge(message_of(kPen, Access::kRead), Permissions::all()));
}

TEST_F(MorapJudge, TakesOtherDevicesForWhatTheyAre) {
  EXPECT_FALSE(lets(kSensor, "01 00 00 80 3F 00", ""));
  EXPECT_TRUE(lets(kSensor, "01 00 00 80 3F 00", "state"));
}

TEST_F(MorapJudge, StopsANodeUntilItHasAcknowledgedThatItIsDisabled) {
  EXPECT_FALSE(judge_->may_be_moving());
  EXPECT_TRUE(lets(kNode, "02 00 00 80 3F", "move"));
  const auto disable = from_hex("24 00").value();
  EXPECT_FALSE(judge_->judge(disable, {}));
  ASSERT_TRUE(judge_->may_be_moving()) << "nobody knows whether the node heard it";
  ASSERT_EQ(judge_->stop().size(), 1U);
  EXPECT_THAT(judge_->stop()[0], testing::ElementsAreArray(disable));
  judge_->observe(disable);
  EXPECT_FALSE(judge_->may_be_moving());
  EXPECT_TRUE(judge_->stop().empty());
}

TEST_F(MorapJudge, OfATransactionThatItRefusesNothingCounts) {
  const auto disable = from_hex("24 00").value();
  const auto reference = from_hex("26 02 00 00 80 3F").value();
  const auto danger = from_hex("24 01 00 00 C0 7F").value();
  EXPECT_TRUE(judge_->judge(std::array<Bytes, 2>{reference, danger}, Permissions::all()));
  EXPECT_FALSE(judge_->may_be_moving());
  EXPECT_FALSE(judge_->judge(std::array<Bytes, 2>{reference, disable}, Permissions::all()));
  EXPECT_EQ(judge_->stop().size(), 1U) << "of the other node";
}

/// A guard before an emulated bus, so that what reaches it can be seen.
class BusGuard : public testing::Test {
 protected:
  static std::unique_ptr<BusPort> bus() {
    i2c::Bus bus;
    bus.attach(emulation::Node{{.eeprom = emulation::dcx22l()}});
    return std::make_unique<EmulatedBusPort<i2c::Bus>>(std::move(bus));
  }
  static Result<Transfer> write(BusPort& port, std::string_view hex) {
    const auto bytes = from_hex(hex).value();
    const auto message = write_to(kNode, bytes);
    return port.transfer({&message, 1});
  }
  static int status(BusPort& port) {
    EXPECT_EQ(write(port, "83"), Transfer::kDone);
    std::array<std::byte, 1> answer{};
    const auto message = read_from(kNode, answer);
    EXPECT_EQ(port.transfer({&message, 1}), Transfer::kDone);
    return std::to_integer<int>(answer[0]);
  }
};

TEST_F(BusGuard, SendsNothingOfWhatItRefuses) {
  const auto guarded = std::move(GuardedBus::guard(bus(), make_judge(), {}).value());
  auto& guard = *guarded;
  EXPECT_EQ(write(guard, "10").error().code, ErrorCode::kForbidden);
  EXPECT_EQ(status(guard), 3) << "still uncalibrated";
  ASSERT_TRUE(guard.last_refusal());
  EXPECT_EQ(guard.last_refusal()->hazard, Hazard::kMove);
}

TEST_F(BusGuard, StopsWhatMovesWhenItRefusesSomething) {
  const auto guarded =
      std::move(GuardedBus::guard(bus(), make_judge(), Permissions::all()).value());
  auto& guard = *guarded;
  ASSERT_EQ(write(guard, "10"), Transfer::kDone);
  ASSERT_EQ(write(guard, "02 00 00 80 3F"), Transfer::kDone);
  ASSERT_EQ(status(guard), 1) << "enabled";
  EXPECT_FALSE(write(guard, "01 00 00 C0 7F"));
  EXPECT_EQ(status(guard), 2) << "disabled";
}

/// Passes everything on to a bus that outlives the guard.
class Borrowed final : public TransactionBus {
 public:
  explicit Borrowed(BusPort& port) : port_{&port} {}
  Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    return port_->transfer(messages);
  }
  void wait_until(Instant time) override { port_->wait_until(time); }
  [[nodiscard]] Instant now() const override { return port_->now(); }

 private:
  BusPort* port_;
};

TEST_F(BusGuard, StopsWhatMovesWhenItGoes) {
  const auto port = bus();
  {
    const auto guarded = std::move(
        GuardedBus::guard(std::make_unique<Borrowed>(*port), make_judge(), Permissions::all())
            .value());
    auto& guard = *guarded;
    ASSERT_EQ(write(guard, "10"), Transfer::kDone);
    ASSERT_EQ(write(guard, "02 00 00 80 3F"), Transfer::kDone);
  }
  EXPECT_EQ(status(*port), 2);
}

}  // namespace
}  // namespace armjig::morap::rig
