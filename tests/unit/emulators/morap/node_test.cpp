// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/node.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cstdint>
#include <span>
#include <string>

#include "emulators/morap/tuner.hpp"
#include "tests/unit/emulators/morap/desk.hpp"
#include "tests/unit/emulators/morap/vectors.hpp"

namespace armjig::morap::emulation {
namespace {

using armjig::test::hex;
using armjig::test::same_bytes;
using test::Desk;

NodeSetup setup_of(char motor, const Profile& profile = kFirmware) {
  NodeSetup setup;
  setup.eeprom = motor == 'A' ? dcx22l() : dcx26l();
  setup.profile = profile;
  return setup;
}

int number(std::string_view text) {
  int value = 1;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// One step of a session of the vectors.
void take_step(Desk& desk, std::string_view step) {
  if (step.starts_with("ADC=")) {
    desk.node().set_conversion(desk.now(), static_cast<std::uint16_t>(number(step.substr(4))));
  } else if (step.starts_with("E=")) {
    desk.turn_to(number(step.substr(2)));
  } else if (step.starts_with('T')) {
    desk.tick(number(step.substr(1)));
  } else if (step.starts_with('W')) {
    const auto data = step.substr(1);
    EXPECT_EQ(desk.write(data), data.size() / 2) << "a node acknowledges every byte";
  } else {
    const auto blank = step.find(' ');
    const auto size = static_cast<std::size_t>(number(step.substr(1, blank - 1)));
    EXPECT_TRUE(same_bytes(desk.read(size), hex(step.substr(blank + 1)))) << step;
  }
}

TEST(MorapNode, AnswersAsTheTestVectorsSay) {
  for (const auto& session : vectors::kSessions) {
    SCOPED_TRACE(session.title);
    Desk desk{setup_of(session.motor)};
    for (auto rest = session.steps; !rest.empty();) {
      const auto end = std::min(rest.find(';'), rest.size());
      take_step(desk, rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
}

TEST(MorapTuner, ComputesEveryBitOfTheTables) {
  for (const auto& tuning : vectors::kTunings) {
    const TuneRequest request{static_cast<TuneKind>(tuning.kind), tuning.inertia, tuning.pole};
    const auto motor = tuning.motor == 'A' ? dcx22l().motor : dcx26l().motor;
    const auto set = tune(request, motor, kFirmware);
    ASSERT_TRUE(set);
    EXPECT_TRUE(same_bytes(encode(*set), hex(tuning.set))) << tuning.motor << tuning.kind;
  }
}

/// Compilers differ in the sign of a NaN that they let a machine compute.
TEST(MorapTuner, ComputesOneNan) {
  for (const auto kind : {TuneKind::kPdPosition, TuneKind::kPidPosition, TuneKind::kPiSpeed}) {
    const auto set = tune({kind, 0.0F, -1.0F}, dcx22l().motor, kFirmware);
    ASSERT_TRUE(set);
    for (const auto& [count, values] : {set->c, set->d, set->f}) {
      for (const float value : std::span{values}.first(count)) {
        EXPECT_EQ(std::bit_cast<std::uint32_t>(value), 0x7FC00000U);
      }
    }
  }
}

TEST(MorapNode, AcceptsEveryWorkedExampleOfAProgram) {
  for (const auto program : vectors::kPrograms) {
    Desk desk{setup_of('A')};
    desk.write(program);
    desk.write("84");
    EXPECT_EQ(desk.read(1), hex("02")) << program;
  }
}

TEST(MorapNode, ByteCountersWrapAt256) {
  // morap.read.wrap: the value is sampled anew at byte 256.
  Desk desk{setup_of('A')};
  desk.turn_to(1000);
  desk.node().start(desk.now(), true);
  armjig::test::ByteVector bytes;
  for (int i = 0; i < 260; ++i) {
    if (i == 101) desk.turn_to(2000);
    bytes.push_back(desk.node().read(desk.now()));
  }
  EXPECT_TRUE(same_bytes(Bytes{bytes}.first(4), hex("8B 68 59 3D")));
  EXPECT_TRUE(same_bytes(Bytes{bytes}.last(4), hex("8B 68 D9 3D")));
  // morap.write.wrap: so is a command read anew.
  std::string text = "06" + std::string(std::size_t{255} * 2, '0') + "10";
  desk.write(text);
  EXPECT_EQ(desk.node().status(), MotorStatus::kDisabled) << "byte 256 calibrates";
}

TEST(MorapNode, FlagsWhatWouldTouchForeignMemory) {
  Desk desk{setup_of('A')};
  desk.write("01 00 00 80 3F 00 00");
  EXPECT_EQ(desk.node().count_of(Undefined::kOverlongFloat), 2U);
  desk.write("80");
  EXPECT_TRUE(same_bytes(desk.read(6), hex("00 00 00 00 00 00")));
  EXPECT_EQ(desk.node().count_of(Undefined::kReadPastFloat), 2U);
  desk.write("20 00 C8 00 00 00 00 00 00 00 00 37");  // no coefficient at all
  desk.tick();
  EXPECT_EQ(desk.node().count_of(Undefined::kEmptyFilter), 0U) << "programming it is harmless";
  desk.write("10");
  desk.tick();
  EXPECT_GT(desk.node().count_of(Undefined::kEmptyFilter), 0U) << "running it is not";
  desk.write("11 00 00 C0 7F");  // calibrated to no number
  EXPECT_EQ(desk.node().count_of(Undefined::kConversion), 1U);
}

/// A set is accepted and waits for its tick; then what `second` is the beginning of comes. The set
/// that is in use after the tick, read back.
armjig::test::ByteVector torn_set(std::string_view first, std::string_view second,
                                  std::size_t size) {
  Desk desk{setup_of('A')};
  desk.write(first);
  desk.write(second);
  desk.tick();
  desk.write("8A");
  return desk.read(size);
}

TEST(MorapNode, KeepsTheUpperByteOfTheRateUntilItsOwnByteComes) {
  // Recording random/mini-rate-torn: 0190, then 32.
  EXPECT_TRUE(same_bytes(torn_set("20 00 90 01 00 00 00 00 00 00 00 6E", "20 00 32", 4),
                         hex("00 32 01 00")));
}

TEST(MorapNode, ReadsBackARefusedCountAndGoesOnIntoTheNextField) {
  // Recording random/mini-count5-active has the first four bytes. In the EEPROM's record, what
  // follows the four values of d is nc, an unused byte, and half of c[0] = 00 00 00 3F. The sum is
  // 56 + 674 + 547 + 522 + 675 + 320 = AEA, folded F4, its complement 0B.
  constexpr std::string_view kExample9 =
      "20 00 71 02 04 CD CC CC 3D CD CC 4C 3E 9A 99 99 3E CD CC CC 3E 04 00 00 00 3F 9A 99 19 3F "
      "33 33 33 3F CD CC 4C 3F 04 CD CC CC BD CD CC 4C BE 9A 99 99 BE CD CC CC BE 0A D7 23 3C 7B";
  EXPECT_TRUE(same_bytes(torn_set(kExample9, "20 00 32 01 05", 32),
                         hex("00 32 01 05 CD CC CC 3D CD CC 4C 3E 9A 99 99 3E CD CC CC 3E "
                             "00 00 00 00 00 00 0A D7 23 3C 0B 00")));
  // With 255, byte 62 is the first after the record; zeros stand for what is there.
  const auto longest = torn_set(kExample9, "20 00 32 01 FF", 256);
  EXPECT_TRUE(same_bytes(Bytes{longest}.subspan(52, 8), hex("CD CC CC BE 0A D7 23 3C")));
  EXPECT_TRUE(same_bytes(Bytes{longest}.subspan(60, 4), hex("00 00 00 00")));
}

TEST(MorapNode, LeavesTheCoefficientsThatItDoesNotTune) {
  // Recording random/mini-tune-leftover: d[2] and d[3] are those of the first message.
  Desk desk{setup_of('A')};
  desk.write("20 00 90 01 04 00 00 80 3F 00 00 00 40 00 00 40 40 00 00 80 40 00 00 00 00 00 00 29");
  desk.tick();
  desk.write("22 00 CD CC 4C 3E 00 00 10 C1");
  desk.write("20 00 90 01 04");
  desk.tick();
  desk.write("8A");
  EXPECT_TRUE(same_bytes(desk.read(28), hex("00 90 01 04 36 4B 03 C1 51 3F 14 41 00 00 40 40 "
                                            "00 00 80 40 00 00 00 00 00 00 FC 00")));
}

TEST(MorapNode, WithAnUnusableEepromNeverJoinsTheBus) {
  auto setup = setup_of('A');
  EXPECT_TRUE(Node{setup}.acknowledges(0x12));
  EXPECT_FALSE(Node{setup}.acknowledges(0x13));
  EXPECT_FALSE(Node{setup}.acknowledges(0x00));
  setup.eeprom.marker = 0xFFFF;
  EXPECT_FALSE(Node{setup}.acknowledges(0x12));
  setup = setup_of('A');
  setup.eeprom.position.kind = ControllerKind::kSpeed;
  EXPECT_FALSE(Node{setup}.acknowledges(0x12));
  setup = setup_of('A');
  setup.eeprom.node = 16;
  EXPECT_TRUE(Node{setup}.acknowledges(0x10)) << "the same as node 0";
  setup.eeprom.node = 17;
  EXPECT_FALSE(Node{setup}.acknowledges(0x11));
}

TEST(MorapNode, ForgetsAllButTheEepromWhenPowerFails) {
  Desk desk{setup_of('A')};
  desk.turn_to(77);
  desk.write("10");
  desk.write("02 00 00 80 3F");
  desk.write("22 02 CD CC CC 3D 00 00 48 C2");
  desk.tick(3);
  desk.node().restart(desk.now());
  EXPECT_EQ(desk.node().status(), MotorStatus::kNeedsCalibration);
  EXPECT_EQ(desk.node().programming_status(), ProgrammingStatus::kNothing);
  EXPECT_EQ(desk.node().output().bridge, Bridge::kShorted) << "until the first tick";
  EXPECT_EQ(desk.read(4), hex("00 00 00 00"));
  EXPECT_TRUE(same_bytes(encode(desk.node().speed_set()), encode(dcx22l().speed)));
  desk.tick();
  EXPECT_EQ(desk.node().output().bridge, Bridge::kOpen);
}

TEST(MorapNode, CopyIsASnapshot) {
  Desk desk{setup_of('A')};
  desk.write("10");
  desk.write("01 CD CC CC 3D");
  desk.tick(2);
  auto copy = desk;
  desk.tick(5);
  copy.tick(5);
  EXPECT_EQ(copy.read(4), desk.read(4));
  desk.write("00");
  EXPECT_EQ(copy.node().status(), MotorStatus::kEnabled);
}

TEST(MorapNode, DocumentedProfileDiffersOnlyWhereTheDocumentSaysSo) {
  const auto status_after = [](std::string_view first, std::string_view second) {
    Desk desk{setup_of('A', kDocumented)};
    desk.write(first);
    desk.write(second);
    desk.write("84");
    return std::pair{desk.node().status(), desk.read(1)};
  };
  using enum MotorStatus;
  EXPECT_EQ(status_after("10", "04 00 00 00 00").first, kDisabled) << "an undocumented command";
  EXPECT_EQ(status_after("10", "03 00 00 00 00").first, kEnabled);
  EXPECT_EQ(status_after("10", "20 02 71 02 00 00 00 00 00 00 00 8A").second, hex("03"));
  EXPECT_EQ(status_after("10", "20 00 00 00 00 00 00 00 00 00 00 FF").second, hex("03"));
  EXPECT_EQ(status_after("10", "22 00 00 00 00 00 00 00 10 C1").second, hex("03")) << "no inertia";
  EXPECT_EQ(status_after("10", "22 00 CD CC 4C 3E 00 00 00 00").second, hex("03")) << "no pole";
  auto setup = setup_of('A', kDocumented);
  setup.eeprom.node = 8;
  EXPECT_FALSE(Node{setup}.acknowledges(0x18));
}

TEST(MorapNode, DocumentedBrakeShortsADisabledMotorUntilItIsDrivenAgain) {
  Desk desk{setup_of('A', kDocumented)};
  desk.tick();
  EXPECT_EQ(desk.node().output().bridge, Bridge::kOpen);
  desk.write("0F");
  desk.tick();
  EXPECT_EQ(desk.node().output().bridge, Bridge::kShorted);
  desk.write("0E");
  desk.tick();
  EXPECT_EQ(desk.node().output().bridge, Bridge::kOpen);
  desk.write("0F");
  desk.write("10");
  desk.write("03 00 00 80 3F");
  desk.tick();
  EXPECT_EQ(desk.node().output().bridge, Bridge::kDriven);
}

TEST(MorapNode, TickPeriodsAreThoseOfTheTimer) {
  // docs/spec/morap.md, section Timer: (period register + 1) times the prescaler.
  EXPECT_EQ(tick_period(200), 10001 * 8);
  EXPECT_EQ(tick_period(320), 50001);
  EXPECT_EQ(tick_period(625), 25601);
  EXPECT_EQ(tick_period(245), 65307);
  EXPECT_EQ(tick_period(244), 8197 * 8);
  EXPECT_EQ(tick_period(1), 62501 * 256);
  EXPECT_EQ(tick_period(0), 65536 * 256);
}

TEST(MorapNode, PassesIdleTimeWithoutCountingEveryTick) {
  Desk desk{setup_of('A')};
  desk.node().advance_to(at(std::chrono::hours{24 * 365}));
  EXPECT_GT(desk.node().next_tick(), at(std::chrono::hours{24 * 365}));
  EXPECT_LE(desk.node().next_tick(),
            at(std::chrono::hours{24 * 365} + std::chrono::microseconds{5001}));
}

}  // namespace
}  // namespace armjig::morap::emulation
