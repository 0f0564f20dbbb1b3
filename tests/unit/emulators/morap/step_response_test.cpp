// SPDX-License-Identifier: Apache-2.0
// The loops that the tuner designs, closed over a plant, against the poles of the same parameters
// in a linear loop.
#include "emulators/morap/step_response.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "emulators/morap/tuner.hpp"

namespace armjig::morap::emulation {
namespace {

/// A joint without friction, whose rated current is so high that nothing limits.
StepTest frictionless(const TuneRequest& tuning, float reference) {
  StepTest test;
  test.node.eeprom = dcx22l();
  test.node.eeprom.motor.friction = 0.0F;
  test.node.eeprom.motor.rated_current = 100.0F;
  test.node.plant = plant_of(test.node.eeprom.motor, static_cast<double>(tuning.inertia), 0.0);
  test.controller = tuning;
  test.reference = reference;
  return test;
}

/// The linear loop that the parameters close: their difference equations in real numbers, a zero-
/// order hold and a period of delay, the motor without inductance. Its answer is that of its poles.
class LinearLoop {
 public:
  LinearLoop(const ControllerSet& set, const StepTest& test)
      : set_{set}, reference_{static_cast<double>(test.reference)} {
    const auto& p = *test.node.plant;
    const double torque_per_volt = p.efficiency * p.torque_constant * p.gear_ratio / p.resistance;
    gain_ = torque_per_volt / p.inertia;
    pole_ = torque_per_volt * p.torque_constant * p.gear_ratio / p.inertia;
  }

  /// Angle and speed at `t`, which never decreases.
  void advance_to(double t) {
    constexpr double kFirstTick = 2e-6;  // four idle periods behind 20 ms
    const double period = static_cast<double>(tick_period(set_.rate_hz)) / 16e6;
    for (; kFirstTick + ticks_ * period <= t; ++ticks_) {
      flow_to(kFirstTick + ticks_ * period);
      tick();
    }
    flow_to(t);
  }
  [[nodiscard]] double angle() const { return angle_; }
  [[nodiscard]] double speed() const { return speed_; }

 private:
  void flow_to(double t) {
    const double h = t - time_;
    const double decay = std::exp(-pole_ * h);
    const double end_speed = gain_ / pole_ * volts_;
    angle_ += end_speed * h + (speed_ - end_speed) * (1.0 - decay) / pole_;
    speed_ = end_speed + (speed_ - end_speed) * decay;
    time_ = t;
  }

  void tick() {
    const double rate = set_.rate_hz;
    const bool is_speed = set_.kind == ControllerKind::kSpeed;
    volts_ = next_volts_;
    const double y = is_speed ? (angle_ - last_angle_) * rate : angle_;
    if (ticks_ == 0) last_r_ = reference_;
    const auto d = values(set_.d);
    const auto c = values(set_.c);
    const double f = values(set_.f)[0];
    feedback_ = d[1] * y + d[0] * last_y_ - f * feedback_;
    feedforward_ = c[1] * reference_ + c[0] * last_r_ - f * feedforward_;
    integral_ += static_cast<double>(set_.integral) * (reference_ - y);
    next_volts_ = feedforward_ - feedback_ + integral_;
    last_y_ = y;
    last_r_ = reference_;
    last_angle_ = angle_;
  }

  static std::array<double, 2> values(const Coefficients& filter) {
    return {static_cast<double>(filter.values[0]), static_cast<double>(filter.values[1])};
  }

  ControllerSet set_;
  double reference_;
  double gain_ = 0.0;
  double pole_ = 0.0;
  int ticks_ = 0;
  double time_ = 0.0;
  double angle_ = 0.0;
  double speed_ = 0.0;
  double volts_ = 0.0;
  double next_volts_ = 0.0;
  double feedback_ = 0.0;
  double feedforward_ = 0.0;
  double integral_ = 0.0;
  double last_y_ = 0.0;
  double last_r_ = 0.0;
  double last_angle_ = 0.0;
};

struct Case {
  TuneRequest tuning;
  float reference;
};

class TunedLoop : public testing::TestWithParam<Case> {};

TEST_P(TunedLoop, AnswersAStepWithItsPoles) {
  const auto& [tuning, reference] = GetParam();
  const auto test = frictionless(tuning, reference);
  const auto response = run(test);
  ASSERT_TRUE(response.is_accepted);
  ASSERT_LT(response.peak_volts, 20.0) << "saturated: the step is too large for this test";
  const double count = 1.0 / test.node.plant->counts_per_radian / std::fabs(double{reference});
  const double tolerance = 0.02 + count;
  LinearLoop loop{*tune(tuning, test.node.eeprom.motor, kFirmware), test};
  double worst = 0.0;
  double overshoot = 0.0;
  double settled = 0.0;
  double expected_settled = 0.0;
  for (const auto& sample : response.samples) {
    const double t = std::chrono::duration<double>{sample.time}.count();
    loop.advance_to(t);
    const bool is_speed = tuning.kind == TuneKind::kPiSpeed;
    const double expected = (is_speed ? loop.speed() : loop.angle()) / double{reference};
    const double actual = sample.value / double{reference};
    worst = std::max(worst, std::fabs(actual - expected));
    overshoot = std::max(overshoot, expected - 1.0);
    if (std::fabs(expected - 1.0) > kSettlingBand) expected_settled = t;
    if (std::fabs(actual - 1.0) > kSettlingBand + tolerance) settled = t;
  }
  EXPECT_LT(worst, tolerance) << "anywhere on the way";
  EXPECT_NEAR(response.overshoot, overshoot, tolerance);
  EXPECT_NEAR(response.final_value / double{reference}, 1.0, tolerance);
  EXPECT_GT(settled, 0.0);
  EXPECT_LE(settled, expected_settled) << "within the tolerance it settles when the poles say so";
}

INSTANTIATE_TEST_SUITE_P(AllKinds, TunedLoop,
                         testing::Values(Case{{TuneKind::kPdPosition, 0.2F, -9.0F}, 0.3F},
                                         Case{{TuneKind::kPdPosition, 0.05F, -6.0F}, -0.5F},
                                         Case{{TuneKind::kPidPosition, 0.2F, -6.0F}, 0.3F},
                                         Case{{TuneKind::kPidPosition, 0.05F, -9.0F}, -0.3F},
                                         Case{{TuneKind::kPiSpeed, 0.1F, -20.0F}, 1.0F},
                                         Case{{TuneKind::kPiSpeed, 0.2F, -12.0F}, -0.8F}));

TEST(StepResponse, SaysIfTheNodeRefusesTheTuning) {
  EXPECT_FALSE(run(frictionless({TuneKind::kPdPosition, 0.2F, 1.0F}, 0.5F)).is_accepted);
}

TEST(StepResponse, ShowsWhatDryFrictionCostsWithoutAnIntegrator) {
  auto test = frictionless({TuneKind::kPdPosition, 0.05F, -9.0F}, 0.5F);
  const auto free = run(test);
  test.node.plant->dry_friction = 0.2;
  const auto held = run(test);
  EXPECT_LT(held.final_value, free.final_value - 0.001) << "it sticks short of the target";
}

TEST(StepResponse, IsTheSameOfASetThatIsProgrammedInsteadOfTuned) {
  auto test = frictionless({TuneKind::kPidPosition, 0.2F, -6.0F}, 0.3F);
  const auto tuned = run(test);
  test.controller = tuned.controller;
  const auto programmed = run(test);
  ASSERT_TRUE(programmed.is_accepted);
  EXPECT_EQ(programmed.final_value, tuned.final_value);
  EXPECT_EQ(programmed.peak_volts, tuned.peak_volts);
}

}  // namespace
}  // namespace armjig::morap::emulation
