// SPDX-License-Identifier: Apache-2.0
// What the suite believes of a node and what the emulated node does were written apart. Here they
// meet.
#include "conformance/morap/laws.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "conformance/morap/host/check.hpp"
#include "conformance/morap/motors.hpp"
#include "emulators/morap/node.hpp"
#include "emulators/morap/tuner.hpp"
#include "harness/core/hex.hpp"
#include "harness/rig/morap_judge.hpp"
#include "tests/unit/emulators/morap/desk.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig::morap::conformance {
namespace {

using emulation::Node;
using emulation::test::Desk;

/// More than rounding to levels explains, in levels: the node counts in single precision.
constexpr double kDoubt = 0.05;

emulation::Eeprom eeprom_of(const Motor& motor) { return emulation::eeprom_of(motor.known, 2); }

const Motor& any_motor() { return motors()[*rc::gen::inRange<std::size_t>(0, motors().size())]; }

/// From -most to most, in steps of a 512th of it; often 0.
float any_number(float most) {
  if (*rc::gen::inRange(0, 16) == 0) return 0.0F;
  return most * static_cast<float>(*rc::gen::inRange(-512, 513)) / 512.0F;
}

/// A node with a held shaft, calibrated there.
class Workbench {
 public:
  explicit Workbench(const Motor& motor) : desk_{{.eeprom = eeprom_of(motor)}} {
    send({CommandId::kCalibrateZero});
    tick();
  }
  void send(const Command& command) { desk_.write(to_hex(encode(command).view())); }
  void turn_to(int counts) { desk_.turn_to(counts); }
  void tick() { desk_.tick(); }
  [[nodiscard]] double level() { return desk_.node().output().level - 512.0; }
  [[nodiscard]] Node& node() { return desk_.node(); }

 private:
  Desk desk_;
};

bool is_level(double level, double volts) {
  return std::fabs(level - volts / static_cast<double>(kVoltsPerLevel)) <= 0.5 + kDoubt;
}

TEST(MorapLaw, HasThePeriodOfEachRate) {
  for (int rate = 1; rate <= UINT16_MAX; ++rate) {
    const auto hz = static_cast<std::uint16_t>(rate);
    ASSERT_EQ(tick_period(hz), emulation::instant_of(emulation::tick_period(hz)) - Instant{}) << hz;
  }
}

TEST(MorapLaw, HasTheLevelOfEachVoltage) {
  for (int millivolts = -30'000; millivolts <= 30'000; ++millivolts) {
    const auto volts = static_cast<float>(millivolts) / 1000.0F;
    ASSERT_EQ(levels_of(static_cast<double>(volts)), emulation::level_of(volts) - 512) << volts;
  }
  for (emulation::Level level = 85; level <= 939; ++level) {
    EXPECT_EQ(emulation::volts_of(level), static_cast<float>(level - 512) * kVoltsPerLevel);
  }
}

TEST(MorapLaw, HasTheAngleOfEachCount) {
  for (const auto& motor : motors()) {
    const emulation::Scale scale{motor.known.constants};
    for (int count = -200'000; count < 200'000; count += 37) {
      const double wanted = MotorLaw{motor}.angle(count);
      ASSERT_NEAR(static_cast<double>(scale.angle(count)), wanted, 3e-7 * std::fabs(wanted));
    }
  }
}

TEST(MorapLaw, LimitsTheDriveVoltageBySpeed) {
  test::for_all([] {
    const auto& motor = any_motor();
    const MotorLaw law{motor};
    const float volts = any_number(25.0F);
    Workbench bench{motor};
    bench.send({CommandId::kVoltage, volts});
    bench.tick();
    int counts = 0;
    for (int i = 0; i < 5; ++i) {
      const int turned = *rc::gen::inRange(-300, 300);
      bench.turn_to(counts += turned);
      bench.tick();
      const double limited =
          law.limited(static_cast<double>(volts), law.angle(turned) * kIdleRateHz);
      RC_ASSERT(is_level(bench.level(), std::clamp(limited, -20.0, 20.0)));
    }
  });
}

TEST(MorapLaw, DrivesATorqueOverAMovingShaft) {
  test::for_all([] {
    const auto& motor = any_motor();
    const MotorLaw law{motor};
    const float torque = any_number(12.0F);
    Workbench bench{motor};
    bench.send({CommandId::kTorque, torque});
    bench.tick();
    int counts = 0;
    for (int i = 0; i < 5; ++i) {
      const int turned = *rc::gen::inRange(-300, 300);
      bench.turn_to(counts += turned);
      bench.tick();
      const double volts =
          law.torque_voltage(static_cast<double>(torque), law.angle(turned) * kIdleRateHz);
      RC_ASSERT(is_level(bench.level(), std::clamp(volts, -20.0, 20.0)));
    }
  });
}

Coefficients any_filter(float most) {
  Coefficients filter{*rc::gen::inRange<std::uint8_t>(1, kMostCoefficients + 1)};
  for (std::size_t i = 0; i < filter.count; ++i) filter.values[i] = any_number(most);
  return filter;
}

ControllerSet any_set() {
  const ControllerKind kind{*rc::gen::inRange<std::uint8_t>(0, 2)};
  const bool is_speed = kind == ControllerKind::kSpeed;
  const auto rate = *rc::gen::element<std::uint16_t>(200, 320, 400, 500, 625);
  return {kind,
          rate,
          any_filter(is_speed ? 0.5F : 3.0F),
          any_filter(3.0F),
          any_filter(0.25F),
          any_number(0.5F)};
}

/// The applied voltages of a loop while the shaft and the reference wander.
void expect_same_loop(const Motor& motor, const ControllerSet& set, int ticks) {
  Workbench bench{motor};
  const MotorLaw law{motor};
  const auto id = set.kind == ControllerKind::kSpeed ? CommandId::kSpeed : CommandId::kPosition;
  float reference = any_number(2.0F);
  int counts = *rc::gen::inRange(-2000, 2000);
  bench.send({CommandId::kProgram, set});
  bench.tick();
  bench.turn_to(counts);
  bench.send({id, reference});
  LoopLaw loop{motor, set, law.angle(counts), static_cast<double>(reference)};
  bench.tick();
  for (int i = 0; i < ticks; ++i) {
    const double volts = loop.step(law.angle(counts), static_cast<double>(reference));
    if (*rc::gen::inRange(0, 4) == 0) bench.send({id, reference = any_number(2.0F)});
    bench.turn_to(counts += *rc::gen::inRange(-20, 21));
    bench.tick();
    if (!is_level(bench.level(), volts)) RC_FAIL("tick " + std::to_string(i));
  }
}

TEST(MorapLaw, RunsTheSameFeedbackLoop) {
  test::for_all([] { expect_same_loop(any_motor(), any_set(), 30); }, 400);
}

TEST(MorapLaw, RunsTheStoredControllers) {
  test::for_all([] {
    const auto& motor = any_motor();
    const auto eeprom = eeprom_of(motor);
    expect_same_loop(motor, *rc::gen::element(eeprom.position, eeprom.speed), 50);
  });
}

/// Levels of a loop that gets a step, with the counts at each tick.
std::vector<int> levels(const Motor& motor, const ControllerSet& set, double reference,
                        const std::vector<int>& counts) {
  LoopLaw loop{motor, set, 0, reference};
  std::vector<int> levels;
  for (const int count : counts) {
    levels.push_back(levels_of(loop.step(MotorLaw{motor}.angle(count), reference)));
  }
  return levels;
}

TEST(MorapLaw, AnswersAsRecorded) {
  const auto stored = [](std::string_view bytes) {
    return std::get<ControllerSet>(decode_set(*from_hex(bytes)));
  };
  const auto& a = motors()[0];
  const auto& b = motors()[1];
  using testing::ElementsAre;
  // Vectors 64 and 65, and the recordings static-position-locked and static-speed-locked.
  EXPECT_THAT(levels(a, stored(a.position_set), 1, {0, 0, 0, 0, 0}),
              ElementsAre(15, 29, 43, 57, 69));
  EXPECT_THAT(levels(b, stored(b.position_set), 1, {0, 0, 0, 0, 0}),
              ElementsAre(9, 18, 26, 34, 34));
  EXPECT_THAT(levels(a, stored(a.speed_set), 0.2, {0, 0, 0, 0}), ElementsAre(5, 8, 12, 14));
  EXPECT_THAT(levels(b, stored(b.speed_set), 0.2, {0, 0, 0, 0}), ElementsAre(2, 4, 6, 7));
  // 67 counts in 5 ms: a fifth of the back-EMF of that speed is 0.753 V with one motor and 0.704 V
  // with the other, and then four fifths of it each time.
  const ControllerSet gain{ControllerKind::kPosition, 200, {1, {0}}, {1, {10}}, {1, {0}}, 0};
  EXPECT_THAT(levels(a, gain, 1, {0, 0, 67, 67, 67, 67}), ElementsAre(69, 69, 85, 82, 79, 77));
  EXPECT_THAT(levels(b, gain, 1, {0, 0, 67, 67, 67, 67}), ElementsAre(34, 34, 49, 46, 44, 42));
}

TEST(MorapMotors, AreThoseOfTheEmulatedNodes) {
  for (const auto& motor : motors()) {
    SCOPED_TRACE(motor.known.name);
    const auto eeprom = eeprom_of(motor);
    const emulation::Scale scale{eeprom.motor};
    const auto says = [](float number) { return to_hex_dump(encode(number)); };
    EXPECT_EQ(to_hex_dump(encode(eeprom.position).view()), motor.position_set);
    EXPECT_EQ(to_hex_dump(encode(eeprom.speed).view()), motor.speed_set);
    EXPECT_EQ(says(scale.angle(1)), motor.one_count);
    EXPECT_EQ(says(scale.angle(1000)), motor.thousand_counts);
    EXPECT_EQ(says(scale.angle(scale.count(1.0F))), motor.one_radian);
    EXPECT_EQ(says(scale.angle(scale.count(-0.52F))), motor.minus_half);
    EXPECT_EQ(levels_of(MotorLaw{motor}.limited(20, 0)), motor.standstill_levels);
    for (const auto& [request, set] : motor.tuned) {
      const auto tuned = tune(request, eeprom.motor, emulation::kFirmware);
      ASSERT_TRUE(tuned);
      EXPECT_EQ(to_hex_dump(encode(*tuned).view()), set);
    }
  }
}

TEST(MorapLaw, KnowsTheLoadWithWhichTheTunerChangesItsRate) {
  for (const auto& motor : motors()) {
    const auto rate = [&](TuneKind kind, double pole) {
      const TuneRequest request{kind, static_cast<float>(MotorLaw{motor}.inertia(pole)), -9.0F};
      return tune(request, motor.known.constants, emulation::kFirmware)->rate_hz;
    };
    for (double pole = 20.05; pole < 250; pole += 0.1) {
      ASSERT_EQ(rate(TuneKind::kPdPosition, pole), pole > 70 ? 625 : 400) << pole;
      ASSERT_EQ(rate(TuneKind::kPiSpeed, pole), pole > 150 ? 625 : pole > 100 ? 400 : 320) << pole;
    }
  }
}

// ---- Masters

/// A command of any sort, whose figures are often wrong.
Command any_command() {
  using enum CommandId;
  const auto id =
      *rc::gen::element(kDisable, kPosition, kSpeed, kVoltage, kCalibrateZero, kCalibrateAngle,
                        kCalibrationUnknown, kDefaultControllers, kProgram, kTune, kReadAngle);
  if (has_number(id)) return {id, any_number(1.0F)};
  if (id == kTune) {
    return {id, TuneRequest{TuneKind{*rc::gen::inRange<std::uint8_t>(0, 5)}, any_number(16.0F),
                            any_number(256.0F)}};
  }
  if (id != kProgram) return {id};
  auto set = any_set();
  set.kind = ControllerKind{*rc::gen::inRange<std::uint8_t>(0, 4)};
  if (*rc::gen::inRange(0, 3) == 0) set.rate_hz = 0;
  return {id, set};
}

/// What the judge of masters complains about when a command is all that it sees of a session.
std::vector<std::string> complaints(const std::vector<std::vector<std::byte>>& session) {
  const auto checker = programs::program_check().make({});
  Instant time{};
  for (auto bytes : session) {
    bytes.insert(bytes.begin(), std::byte{0x24});
    checker->to_device(time += std::chrono::seconds{1}, bytes);
  }
  checker->finish(time);
  std::vector<std::string> names;
  for (const auto& offence : checker->take_offences()) names.emplace_back(offence.requirement);
  return names;
}

bool has(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

std::vector<std::byte> written(const Command& command) {
  const auto bytes = encode(command);
  return {bytes.view().begin(), bytes.view().end()};
}

TEST(MorapMasters, AreToldOfWhatADocumentedNodeRefuses) {
  test::for_all(
      [] {
        auto bytes = written(any_command());
        if (!is_programming(CommandId{std::to_integer<std::uint8_t>(bytes[0])})) return;
        if (*rc::gen::inRange(0, 4) == 0) bytes.back() ^= std::byte{1};
        Desk desk{{.eeprom = emulation::dcx22l(), .profile = emulation::kDocumented}};
        desk.write(to_hex(bytes));
        const auto found = complaints({bytes});
        bool is_told = false;
        for (const auto* name :
             {"checksum", "counts", "kind", "rate", "tune-kind", "tune-inertia", "tune-pole"}) {
          is_told = is_told || has(found, std::string{"morap.host."} + name);
        }
        RC_ASSERT(is_told == (desk.node().programming_status() == ProgrammingStatus::kFailure));
      },
      4000);
}

TEST(MorapMasters, AreSeenInTheStatesThatTheNodeHas) {
  test::for_all(
      [] {
        Desk desk{{.eeprom = emulation::dcx22l()}};
        std::vector<std::vector<std::byte>> session;
        const auto guard = rig::make_judge();
        bool is_early = false;
        const int length = *rc::gen::inRange(1, 12);
        for (int i = 0; i < length; ++i) {
          const auto command = any_command();
          const auto was = desk.node().status();
          session.push_back(written(command));
          desk.write(to_hex(session.back()));
          is_early =
              is_early || (is_reference(command.id) && was == MotorStatus::kNeedsCalibration);
          auto transaction = session.back();
          transaction.insert(transaction.begin(), std::byte{0x24});
          guard->observe(transaction);
        }
        const auto found = complaints(session);
        const bool is_enabled = desk.node().status() == MotorStatus::kEnabled;
        RC_ASSERT(has(found, "morap.host.calibrates-first") == is_early);
        if (is_enabled) RC_ASSERT(has(found, "morap.host.ends-disabled"));
        if (is_enabled) RC_ASSERT(guard->may_be_moving());
      },
      4000);
}

}  // namespace
}  // namespace armjig::morap::conformance
