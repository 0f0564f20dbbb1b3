// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/morap/joint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <set>
#include <string_view>

#include "emulators/i2c/bus.hpp"
#include "emulators/morap/node.hpp"
#include "emulators/morap/pen.hpp"
#include "harness/link/emulated_bus_port.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig::morap::drive {
namespace {

using namespace emulation;
using namespace std::chrono_literals;
using i2c::Trouble;
using test::same_bytes;
using ::testing::ElementsAre;

/// Two joints and a pen on an emulated bus.
class MorapDrive : public testing::Test {
 protected:
  static i2c::Bus make_bus() {
    i2c::Bus bus;
    bus.attach(Node{{.eeprom = dcx22l()}});
    bus.attach(Node{{.eeprom = dcx26l()}});
    bus.attach(Pen{});
    return bus;
  }
  Node& node() { return port_.bus().device<Node>(0); }
  void expect(const Trouble& trouble) { port_.bus().expect(trouble); }

  EmulatedBusPort<i2c::Bus> port_{make_bus()};
  Master master_{port_};
  Joint joint_{master_, {0x12}};
};

TEST_F(MorapDrive, ScanFindsWhoIsThere) {
  EXPECT_THAT(master_.scan().addresses,
              ElementsAre(BusAddress{0x11}, BusAddress{0x12}, BusAddress{0x19}));
}

TEST_F(MorapDrive, DrivesAJoint) {
  EXPECT_EQ(joint_.status().value, MotorStatus::kNeedsCalibration);
  EXPECT_EQ(joint_.calibrate(Angle{1.0F}), BusCode::kOk);
  EXPECT_EQ(joint_.angle().value, Angle{0.9999935F});  // 18840 counts
  EXPECT_EQ(joint_.set_voltage(Voltage{1.5F}), BusCode::kOk);
  master_.wait(10ms);
  EXPECT_EQ(joint_.voltage().value, Voltage{1.5F});
  EXPECT_EQ(joint_.set_position(Angle{0.5F}), BusCode::kOk);
  EXPECT_EQ(joint_.position_reference().value, Angle{0.5F});
  EXPECT_EQ(joint_.set_speed(Speed{-2.0F}), BusCode::kOk);
  EXPECT_EQ(joint_.speed_reference().value, Speed{-2.0F});
  EXPECT_EQ(joint_.status().value, MotorStatus::kEnabled);
  EXPECT_EQ(joint_.own_address().value, 0x12);
  EXPECT_EQ(joint_.forget_calibration(), BusCode::kOk);
  EXPECT_EQ(joint_.status().value, MotorStatus::kNeedsCalibration);
}

TEST_F(MorapDrive, AnswersAsTheVendorsLibraryIfNobodyIsThere) {
  Joint absent{master_, {0x13}};
  EXPECT_EQ(absent.disable(), BusCode::kNoSuchAddress);
  const auto before = port_.now();
  const auto angle = absent.angle();
  EXPECT_EQ(angle.code, BusCode::kNoSuchAddress);
  EXPECT_EQ(angle.value, Angle{0.0F});
  EXPECT_EQ(port_.now() - before, 110us) << "there is no read after a choice that failed";
  EXPECT_EQ(static_cast<int>(absent.status().value), 255);
}

TEST_F(MorapDrive, GoesOnAfterARefusedByteAndSaysSo) {
  expect({.kind = Trouble::Kind::kNack, .byte = 1});
  const auto before = port_.now();
  EXPECT_EQ(joint_.set_position(Angle{1.0F}), BusCode::kByteRefused);
  EXPECT_EQ(port_.now() - before, 560us) << "the rest was sent all the same";
}

TEST_F(MorapDrive, TellsCollisionsApart) {
  expect({.kind = Trouble::Kind::kArbitrationLost, .byte = 0});
  EXPECT_EQ(joint_.disable(), BusCode::kStartCollision);
  expect({.kind = Trouble::Kind::kArbitrationLost, .byte = 3});
  EXPECT_EQ(joint_.set_position(Angle{1.0F}), BusCode::kByteCollision);
  expect({.kind = Trouble::Kind::kStretch, .byte = 1, .duration = 1s});
  EXPECT_EQ(joint_.disable(), BusCode::kTimedOut);
}

ControllerSet some_set() {
  return {ControllerKind::kPosition, 400, {2, {1.0F, 2.0F}}, {2, {1.0F, 2.0F}}, {1, {-0.5F}}, 0.0F};
}

TEST_F(MorapDrive, ProgramsAndReadsBack) {
  const auto result = joint_.program(some_set());
  EXPECT_EQ(result.outcome, ProgramOutcome::kDone);
  EXPECT_TRUE(same_bytes(encode(result.active), encode(some_set())));
  EXPECT_TRUE(same_bytes(joint_.controller_set(ControllerKind::kPosition).value,
                         encode(node().position_set())));
}

TEST_F(MorapDrive, RefusesToSendWhatANodeMustNotRun) {
  auto set = some_set();
  set.d.count = 0;
  EXPECT_EQ(joint_.program(set).outcome, ProgramOutcome::kUnsafe);
  set = some_set();
  set.f.count = 5;
  EXPECT_EQ(joint_.program(set).outcome, ProgramOutcome::kUnsafe);
  set = some_set();
  set.c.values[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(joint_.program(set).outcome, ProgramOutcome::kUnsafe);
  set = some_set();
  set.rate_hz = 1501;
  EXPECT_EQ(joint_.program(set).outcome, ProgramOutcome::kUnsafe);
  EXPECT_EQ(port_.now(), at(0us)) << "nothing passed on the bus";
}

/// A bad line: the first coefficient of a parameter message arrives with another bit.
class GarbledBus final : public BusPort {
 public:
  explicit GarbledBus(BusPort& port) : port_{port} {}
  Result<Ack> start(BusAddress address, Access access) override {
    count_ = 0;
    return port_.start(address, access);
  }
  Result<Ack> write(std::byte byte) override {
    constexpr int kCoefficient = 5;
    return port_.write(count_++ == kCoefficient ? byte ^ std::byte{1} : byte);
  }
  Result<std::byte> read(Ack reply) override { return port_.read(reply); }
  Result<void> stop() override { return port_.stop(); }
  void wait_until(Instant time) override { port_.wait_until(time); }
  [[nodiscard]] Instant now() const override { return port_.now(); }

 private:
  BusPort& port_;
  int count_ = 0;
};

TEST_F(MorapDrive, SaysThatANodeRefusesASet) {
  GarbledBus port{port_};
  Master master{port};
  Joint joint{master, joint_.address()};
  EXPECT_EQ(joint.program(some_set()).outcome, ProgramOutcome::kRefused);
  EXPECT_EQ(joint_.programming_status().value, ProgrammingStatus::kFailure);
}

TEST_F(MorapDrive, NoticesASetThatIsAcceptedButInstalledNowhere) {
  auto set = some_set();
  set.kind = ControllerKind{2};  // morap.program.other-kind
  EXPECT_EQ(joint_.program(set).outcome, ProgramOutcome::kNotActive);
}

TEST_F(MorapDrive, NoticesASetThatWasDamagedOnTheWay) {
  expect({.kind = Trouble::Kind::kNack, .address = 0x12, .byte = 5});
  EXPECT_EQ(joint_.program(some_set()).outcome, ProgramOutcome::kBusFailed);
}

TEST_F(MorapDrive, TunesAndReportsWhatTheNodeComputed) {
  const auto result = joint_.tune({TuneKind::kPiSpeed, 0.1F, -50.0F});
  EXPECT_EQ(result.outcome, ProgramOutcome::kDone);
  // Spec, test vector 43.
  EXPECT_TRUE(
      same_bytes(encode(result.active),
                 test::hex("014001025EB0EC3D5EB0EC3D02699FE4BF579B2C4001BF5820BF73380D3F49")));
  EXPECT_EQ(joint_.tune({TuneKind::kPdPosition, 0.2F, 1.0F}).outcome, ProgramOutcome::kRefused);
}

TEST_F(MorapDrive, MovesThePen) {
  PenDrive pen{master_};
  EXPECT_EQ(pen.deploy(), BusCode::kOk);
  EXPECT_EQ(port_.bus().device<Pen>(2).servo_degrees(), 8);
  EXPECT_EQ(pen.set_position(128), BusCode::kOk);
  EXPECT_EQ(port_.bus().device<Pen>(2).servo_degrees(), 27);
  EXPECT_EQ(pen.retract(), BusCode::kOk);
  EXPECT_EQ(port_.bus().device<Pen>(2).servo_degrees(), 45);
}

TEST(BusCode, EachHasASentenceOfItsOwn) {
  std::set<std::string_view> sentences;
  for (const int code : {0, 1, 2, 3, 4, 6}) {
    EXPECT_TRUE(sentences.insert(describe(static_cast<BusCode>(code))).second) << code;
  }
  for (int outcome = 0; outcome <= static_cast<int>(ProgramOutcome::kNotActive); ++outcome) {
    EXPECT_TRUE(sentences.insert(describe(static_cast<ProgramOutcome>(outcome))).second) << outcome;
  }
}

}  // namespace
}  // namespace armjig::morap::drive
