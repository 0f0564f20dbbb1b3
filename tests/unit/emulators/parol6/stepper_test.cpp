// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/stepper.hpp"

#include <gtest/gtest.h>

#include <array>
#include <ostream>
#include <vector>

#include "tests/unit/support/bytes.hpp"

namespace armjig::parol6::emulation {
namespace {

Stepper stepper_with(float acceleration, float max_speed = 50'000.0F) {
  Stepper stepper;
  stepper.set_max_speed(StepRate{max_speed});
  stepper.set_acceleration(StepsPerSecond2{acceleration});
  return stepper;
}

// Section 5.4.

TEST(Stepper, TruncatesASpeedToAWholeInterval) {
  struct Row {
    float speed;
    std::uint32_t interval;
  };
  for (const auto [speed, interval] :
       {Row{2050, 487}, Row{2550, 392}, Row{5550, 180}, Row{5050, 198}, Row{9550, 104},
        Row{750, 1333}, Row{4050, 246}, Row{8050, 124}, Row{1000, 1000}, Row{150, 6666},
        Row{100, 10000}, Row{7, 142857}, Row{3, 333333}, Row{50000, 20}}) {
    auto stepper = stepper_with(1000);
    stepper.set_speed(StepRate{speed});
    EXPECT_EQ(stepper.interval_us(), interval) << speed;
    EXPECT_EQ(stepper.speed().value, speed);
    EXPECT_EQ(stepper.direction(), 1);
    stepper.set_speed(StepRate{-speed});
    EXPECT_EQ(stepper.interval_us(), interval) << -speed;
    EXPECT_EQ(stepper.direction(), -1);
  }
}

TEST(Stepper, ClampsASpeedToTheMaximum) {
  auto stepper = stepper_with(1000);
  stepper.set_speed(StepRate{-99'999});
  EXPECT_EQ(stepper.interval_us(), 20U);
  EXPECT_EQ(stepper.speed().value, -50'000.0F);
}

TEST(Stepper, AcceleratesFromRestAsTheLibraryDoes) {
  constexpr std::array<std::uint32_t, 12> kIntervals{14251, 8550, 6650, 5627, 4965, 4492,
                                                     4133,  3848, 3614, 3419, 3252, 3108};
  constexpr std::array<float, 12> kSpeeds{70.1688843F, 116.948135F, 150.361893F, 177.700424F,
                                          201.393799F, 222.593155F, 241.949081F, 259.871246F,
                                          276.637115F, 292.444977F, 307.442139F, 321.741791F};
  auto stepper = stepper_with(4500);
  stepper.move_to(Steps{100'000});
  std::uint32_t now = 0;
  for (std::size_t i = 0; i < kIntervals.size(); ++i) {
    EXPECT_EQ(stepper.interval_us(), kIntervals[i]) << i;
    EXPECT_EQ(stepper.speed().value, kSpeeds[i]) << i;
    now += stepper.interval_us();
    stepper.run(Micros{now});
  }
}

TEST(Stepper, BeginsARampWithTheFirstInterval) {
  struct Row {
    float acceleration;
    double interval;
  };
  for (const auto [acceleration, interval] :
       {Row{100, 95600.8}, Row{500, 42754.0}, Row{1000, 30231.6}, Row{3000, 17454.2},
        Row{3500, 16159.5}, Row{4000, 15115.8}, Row{4500, 14251.3}, Row{5000, 13520.0},
        Row{5500, 12890.8}, Row{6000, 12342.0}, Row{7500, 11039.0}, Row{10500, 9329.7}}) {
    auto stepper = stepper_with(acceleration);
    stepper.move_to(Steps{1000});
    EXPECT_NEAR(1e6 / double{stepper.speed().value}, interval, 0.06) << acceleration;
  }
}

TEST(Stepper, StepsAtOnceIfTheLastStepIsLongAgo) {
  auto stepper = stepper_with(1000);
  stepper.set_speed(StepRate{3});
  EXPECT_FALSE(stepper.run_speed(Micros{333'332}));
  EXPECT_TRUE(stepper.run_speed(Micros{333'333}));
  EXPECT_FALSE(stepper.run_speed(Micros{333'334}));
  EXPECT_TRUE(stepper.run_speed(Micros{10'000'000}));
  EXPECT_FALSE(stepper.run_speed(Micros{10'000'001})) << "lateness is not made up for";
  EXPECT_EQ(stepper.position().value, 2);
}

TEST(Stepper, KeepsItsDirectionIfTheSameSpeedIsSetAgain) {
  auto stepper = stepper_with(1000);
  stepper.set_speed(StepRate{-2050});
  stepper.move_to(Steps{2});
  stepper.set_speed(StepRate{-2050});  // the ramp of move_to has set another one
  EXPECT_TRUE(stepper.run_speed_to_position(Micros{1'000'000}));
  EXPECT_EQ(stepper.position().value, 1);
  stepper.set_speed(StepRate{-2050});
  EXPECT_TRUE(stepper.run_speed(Micros{2'000'000}));
  EXPECT_EQ(stepper.position().value, 2) << "moves forward at -2050";
}

TEST(Stepper, WaitsAcrossTheWrapOfTheClock) {
  auto stepper = stepper_with(1000);
  stepper.set_speed(StepRate{1000});
  ASSERT_TRUE(stepper.run_speed(Micros{0xFFFF'FF00}));
  EXPECT_FALSE(stepper.run_speed(Micros{0xFFFF'FF00U + 999}));
  EXPECT_TRUE(stepper.run_speed(Micros{0xFFFF'FF00U + 1000}));
}

TEST(Stepper, StandsStillAfterItsCounterIsSet) {
  auto stepper = stepper_with(1000);
  stepper.move_to(Steps{1000});
  stepper.set_position(Steps{-5});
  EXPECT_EQ(stepper.position().value, -5);
  EXPECT_EQ(stepper.target().value, -5);
  EXPECT_FALSE(stepper.is_running());
  EXPECT_FALSE(stepper.run(Micros{1'000'000'000}));
}

// Section 12.4.

struct Move {
  const char* id;
  float acceleration;
  float max_speed;
  std::int32_t distance;
  std::uint32_t duration_us;
  float peak;  ///< as printed in the reference, six digits

  friend std::ostream& operator<<(std::ostream& out, const Move& move) { return out << move.id; }
};
constexpr std::array kMoves{
    Move{"S1", 4500, 50000, 13500, 3414822, 7794.29F},
    Move{"S2", 3000, 50000, 19588, 5065811, 7665.71F},
    Move{"S3", 5000, 50000, 23020, 4252897, 10728.3F},
    Move{"S4", 5500, 50000, -10200, 2680077, 7490.12F},
    Move{"S5", 10500, 50000, 15900, 2434499, 12920.9F},
    Move{"S6", 5500, 50000, 8900, 2501266, 6996.6F},
    Move{"S7", 5500, 50000, -15900, 3354148, 9351.48F},
    Move{"S8", 6000, 6000, 6179, 2022244, 6000.0F},
    Move{"S9", 4000, 4000, -22222, 6523414, 4000.0F},
    Move{"S10", 3500, 3500, 49812, 15165012, 3500.0F},
    Move{"S11", 7500, 7500, 46075, 7104725, 7500.0F},
    Move{"S12", 1000, 50000, 2, 18138, 55.1299F},
    Move{"S13", 1000, 50000, 3, 48369, 55.1299F},
    Move{"S14", 4500, 50000, 20, 93848, 307.442F},
};

class StepperMove : public testing::TestWithParam<Move> {};

TEST_P(StepperMove, TakesTheTimeThatTheFirmwareTakes) {
  const auto& move = GetParam();
  auto stepper = stepper_with(move.acceleration, move.max_speed);
  stepper.move_to(Steps{move.distance});
  constexpr std::uint32_t kLongAfterTheLastStep = 1'000'000;
  std::uint32_t time = 0;
  float peak = 0.0F;
  for (; stepper.is_running(); ++time) {
    peak = std::max(peak, std::abs(stepper.speed().value));
    stepper.run(Micros{kLongAfterTheLastStep + time});
    ASSERT_LT(time, 20'000'000U);
  }
  EXPECT_EQ(time - 1, move.duration_us) << "the first step is at time 0";
  EXPECT_NEAR(peak, move.peak, move.peak * 5e-6F);
  EXPECT_EQ(stepper.position().value, move.distance);
}

std::string id_of(const testing::TestParamInfo<Move>& move) { return move.param.id; }
INSTANTIATE_TEST_SUITE_P(Reference, StepperMove, testing::ValuesIn(kMoves), id_of);

TEST(Stepper, TakesEachStepOfAShortMoveOnTime) {  // S14
  auto stepper = stepper_with(4500);
  stepper.move_to(Steps{20});
  std::vector<std::uint32_t> times;
  std::vector<std::int32_t> indices;
  for (std::uint32_t now = 0; now < 200'000; ++now) {
    if (!stepper.run(Micros{now})) continue;
    times.push_back(now);
    indices.push_back(stepper.ramp_index());
  }
  EXPECT_EQ(times, (std::vector<std::uint32_t>{14251, 22801, 29451, 35078, 40043, 44535, 48668,
                                               52516, 56130, 59549, 62801, 66220, 69834, 73682,
                                               77815, 82307, 87272, 92899, 99549, 108099}));
  EXPECT_EQ(indices, (std::vector<std::int32_t>{2,  3,  4,  5,  6,  7,  8,  9,  10, 11,
                                                -9, -8, -7, -6, -5, -4, -3, -2, -1, 0}));
}

TEST(Stepper, CarriesItsSpeedIntoTheSecondLegOfJ6) {  // S15
  auto stepper = stepper_with(10'500);
  constexpr std::uint32_t kStart = 1'000'000;
  std::uint32_t now = kStart;
  stepper.move_to(Steps{15'900});
  for (; stepper.is_running(); ++now) stepper.run(Micros{now});
  const auto arrival = now - 1;
  stepper.set_speed(StepRate{1050});
  stepper.set_acceleration(StepsPerSecond2{5500});
  EXPECT_EQ(stepper.speed().value, -77.5746155F);
  EXPECT_EQ(stepper.ramp_index(), 1);
  EXPECT_EQ(stepper.interval_us(), 12'890U);
  stepper.move_to(Steps{0});
  EXPECT_EQ(stepper.speed().value, -129.291031F);
  EXPECT_EQ(stepper.ramp_index(), 2);
  EXPECT_EQ(stepper.interval_us(), 7734U);
  for (; stepper.is_running(); ++now) stepper.run(Micros{now});
  EXPECT_EQ(now - 1 - arrival, 3'367'038U);
}

// The board's go-to law, section 3.4 and B12.

TEST(GoToSpeed, IsTheMeanOfFeedAndClosingSpeedTowardZero) {
  const auto law = [](std::int32_t goal, std::int32_t feed) {
    return go_to_speed(Steps{0}, Steps{goal}, StepsPerSecond{feed}).value;
  };
  EXPECT_EQ(law(100, 200), 5100.0F);
  EXPECT_EQ(law(-100, -200), -5100.0F);
  EXPECT_EQ(law(1, 0), 50.0F);
  EXPECT_EQ(law(-1, 0), -50.0F);
  EXPECT_EQ(law(3, -1), 149.0F);
  EXPECT_EQ(law(-3, 1), -149.0F);
  EXPECT_EQ(law(0, 1), 0.0F);
}

TEST(GoToSpeed, HoldsOverThe24BitRange) {
  EXPECT_EQ(go_to_speed(Steps{-8'388'608}, Steps{8'388'607}, StepsPerSecond{8'388'607}).value,
            static_cast<float>((8'388'607 + 100 * 16'777'215) / 2));
}

// Spans of passes in closed form, against the passes one by one.

PassSpan span(std::int64_t first, std::int64_t passes, std::uint32_t period) {
  return {.first = first,
          .last = first + (passes - 1) * period,
          .period = period,
          .clock_offset = 0xFFFF'0000};
}

template <class Pass>
void each_pass(const PassSpan& span, Pass pass) {
  for (auto time = span.first; time <= span.last; time += span.period) pass(span.clock(time));
}

TEST(StepperSpan, AtConstantSpeedEqualsItsPasses) {
  test::Dice dice{51};
  for (int round = 0; round < 2000; ++round) {
    auto plain = stepper_with(1000);
    plain.set_speed(StepRate{static_cast<float>(dice.between(-60'000, 60'000))});
    auto closed = plain;
    for (int part = 0; part < 3; ++part) {
      const auto passes = span(dice.between(0, 200'000), dice.between(1, 3000),
                               static_cast<std::uint32_t>(dice.between(1, 100)));
      each_pass(passes, [&](Micros now) { plain.run_speed(now); });
      EXPECT_EQ(closed.coast_speed(passes), kNoPass);
      ASSERT_EQ(closed, plain) << "round " << round;
    }
  }
}

TEST(StepperSpan, StopsInFrontOfTheStepThatIsOneTooMany) {
  test::Dice dice{52};
  for (int round = 0; round < 500; ++round) {
    auto plain = stepper_with(1000);
    plain.set_speed(StepRate{static_cast<float>(dice.between(100, 50'000))});
    auto closed = plain;
    const auto passes = span(0, 5000, static_cast<std::uint32_t>(dice.between(1, 50)));
    const auto most = dice.between(0, 20);
    std::int64_t next = kNoPass;
    for (auto time = passes.first; time <= passes.last && next == kNoPass; time += passes.period) {
      auto trial = plain;
      if (trial.run_speed(passes.clock(time)) && trial.position().value > most) {
        next = time;
      } else {
        plain = trial;
      }
    }
    EXPECT_EQ(closed.coast_speed(passes, most), next);
    EXPECT_EQ(closed, plain);
  }
}

TEST(StepperSpan, OfTheGoToLawEqualsItsPasses) {
  test::Dice dice{53};
  for (int round = 0; round < 500; ++round) {
    auto plain = stepper_with(1000);
    auto closed = plain;
    const Steps goal{static_cast<std::int32_t>(dice.between(-2000, 2000))};
    const StepsPerSecond feed{static_cast<std::int32_t>(dice.between(-5000, 5000))};
    const auto passes = span(dice.between(0, 200'000), dice.between(1, 5000),
                             static_cast<std::uint32_t>(dice.between(1, 100)));
    each_pass(passes, [&](Micros now) {
      plain.set_speed(go_to_speed(plain.position(), goal, feed));
      plain.run_speed(now);
    });
    closed.coast_go_to(passes, goal, feed);
    ASSERT_EQ(closed, plain) << "round " << round;
  }
}

TEST(StepperSpan, OfARampStopsInFrontOfTheLanding) {
  test::Dice dice{54};
  for (int round = 0; round < 200; ++round) {
    auto plain = stepper_with(static_cast<float>(dice.between(100, 10'000)));
    plain.move_to(Steps{static_cast<std::int32_t>(dice.between(-3000, 3000))});
    auto closed = plain;
    const auto passes = span(0, 100'000, static_cast<std::uint32_t>(dice.between(1, 100)));
    const auto landing = closed.coast_ramp(passes);
    for (auto time = passes.first; time <= passes.last && time < landing; time += passes.period) {
      plain.run(passes.clock(time));
    }
    ASSERT_EQ(closed, plain) << "round " << round;
    if (landing == kNoPass) continue;
    EXPECT_TRUE(plain.run(passes.clock(landing)));
    EXPECT_EQ(plain.position().value, plain.target().value);
  }
}

TEST(StepperSpan, OfAWeekAtFullSpeedLosesNoStep) {
  // More steps than 32 bits count: 7 days at 50,000 steps/s, one step in 20 us.
  auto stepper = stepper_with(1000);
  stepper.set_speed(StepRate{50'000});
  constexpr std::int64_t kPasses = INT64_C(7) * 24 * 3600 * 50'000;
  const auto week = span(0, kPasses, 20);
  EXPECT_EQ(stepper.coast_speed(week), kNoPass);
  EXPECT_EQ(stepper.position().value,
            static_cast<std::int32_t>(static_cast<std::uint32_t>(kPasses)));
  EXPECT_FALSE(stepper.run_speed(week.clock(week.last)));
  EXPECT_TRUE(stepper.run_speed(week.clock(week.last + 20)));
}

}  // namespace
}  // namespace armjig::parol6::emulation
