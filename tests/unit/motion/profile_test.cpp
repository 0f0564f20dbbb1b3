// SPDX-License-Identifier: Apache-2.0
#include "harness/motion/profile.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "tests/unit/support/property.hpp"

namespace armjig::motion {
namespace {

constexpr double kSlack = 1e-9;

/// From one end to the other within a time, as joints and tools move.
struct Way {
  double from{};
  double to{};
  double duration{};

  [[nodiscard]] double length() const { return std::abs(to - from); }
};

Way any_way() {
  const auto part = [](int least, int most) { return *rc::gen::inRange(least, most) / 100.0; };
  return {part(-30'000, 30'000), part(-30'000, 30'000), part(5, 2000)};
}

bool is_near(double a, double b, double scale) {
  return std::abs(a - b) <= kSlack * (1 + std::abs(scale));
}

/// What every profile of this room promises.
template <class Profile>
void check_promises(const Profile& profile, const Way& way) {
  const double duration = profile.duration();
  const auto first = profile.at(0);
  const auto last = profile.at(duration);
  RC_ASSERT(is_near(first.position, way.from, way.from));
  RC_ASSERT(last.position == way.from + (way.to - way.from));
  RC_ASSERT(first.speed == 0 && is_near(last.speed, 0, way.length() / duration));

  const double u = *rc::gen::inRange(1, 1000) / 1000.0;
  const auto now = profile.at(u * duration);
  const auto mirrored = profile.at((1 - u) * duration);
  RC_ASSERT(is_near(now.position - way.from, way.to - mirrored.position, 30'000));
  RC_ASSERT(is_near(now.speed, mirrored.speed, 1e6));
  RC_ASSERT(std::abs(now.speed) <= profile.peak().speed * (1 + kSlack));
  RC_ASSERT(std::abs(now.acceleration) <= profile.peak().acceleration * (1 + kSlack));
}

/// The reported derivatives are those of the reported positions, inside one phase of a profile.
template <class Profile>
void check_derivatives(const Profile& profile, double t) {
  const double h = 1e-5 * profile.duration();
  const auto before = profile.at(t - h);
  const auto now = profile.at(t);
  const auto behind = profile.at(t + h);
  const double speeds = 1 + profile.peak().speed;
  const double accelerations = 1 + profile.peak().acceleration;
  RC_ASSERT(std::abs((behind.position - before.position) / (2 * h) - now.speed) < 1e-5 * speeds);
  RC_ASSERT(std::abs((behind.speed - before.speed) / (2 * h) - now.acceleration) <
            1e-5 * accelerations);
}

TEST(Quintic, KeepsThePromisesOfAProfile) {
  test::for_all([] {
    const auto way = any_way();
    check_promises(Quintic{way.from, way.to, way.duration}, way);
  });
}

TEST(Quintic, HasExactDerivatives) {
  test::for_all([] {
    const auto way = any_way();
    const double u = *rc::gen::inRange(1, 1000) / 1000.0;
    check_derivatives(Quintic{way.from, way.to, way.duration}, u * way.duration);
  });
}

TEST(Quintic, BeginsAndEndsWithoutAcceleration) {
  const Quintic profile{10, 50, 4};
  EXPECT_EQ(profile.at(0).acceleration, 0);
  EXPECT_NEAR(profile.at(4).acceleration, 0, 1e-12);
}

TEST(Quintic, PeaksAsItSays) {
  const Quintic profile{0, 1, 1};
  EXPECT_DOUBLE_EQ(profile.at(0.5).speed, profile.peak().speed);
  const double hardest = 0.5 - std::sqrt(3.0) / 6;
  EXPECT_NEAR(profile.at(hardest).acceleration, profile.peak().acceleration, 1e-12);
}

TEST(Trapezoid, KeepsThePromisesOfAProfile) {
  test::for_all([] {
    const auto way = any_way();
    check_promises(Trapezoid::thirds(way.from, way.to, way.duration), way);
    const double speed = way.length() / way.duration * *rc::gen::inRange(50, 250) / 100.0;
    check_promises(Trapezoid::cruising(way.from, way.to, speed, way.duration), way);
  });
}

TEST(Trapezoid, HasExactDerivatives) {
  test::for_all([] {
    const auto way = any_way();
    const auto profile = Trapezoid::thirds(way.from, way.to, way.duration);
    const int phase = *rc::gen::inRange(0, 3);
    const double inside = *rc::gen::inRange(1, 100) / 100.0;
    RC_PRE(inside < 0.99);
    check_derivatives(profile, (phase + inside) * way.duration / 3);
  });
}

TEST(Trapezoid, OfThirdsCruisesAtOneAndAHalfOfTheMean) {
  const auto profile = Trapezoid::thirds(0, 80, 4);
  EXPECT_DOUBLE_EQ(profile.cruise(), 30);
  EXPECT_DOUBLE_EQ(profile.at(2).speed, 30);
  EXPECT_DOUBLE_EQ(profile.blend(), 4.0 / 3);
}

TEST(Trapezoid, CruisesAtTheSpeedThatSuitsItsTime) {
  const auto profile = Trapezoid::cruising(100, 20, 25, 4);
  EXPECT_DOUBLE_EQ(profile.at(2).speed, -25);
  EXPECT_DOUBLE_EQ(profile.blend(), 4 - 80.0 / 25);
}

TEST(Trapezoid, FallsBackToThirdsAtASpeedThatDoesNotSuitItsTime) {
  for (const double speed : {19.0, 20.0, 40.1}) {  // the mean is 20
    EXPECT_DOUBLE_EQ(Trapezoid::cruising(0, 80, speed, 4).at(2).speed, 30) << speed;
  }
}

TEST(Trapezoid, IsNeverFasterThanItMay) {
  test::for_all([] {
    const auto way = any_way();
    RC_PRE(way.length() > 0.01);
    const double speed = *rc::gen::inRange(1, 500);
    const double acceleration = *rc::gen::inRange(1, 2000);
    const auto profile = Trapezoid::fastest(way.from, way.to, speed, acceleration);
    check_promises(profile, way);
    RC_ASSERT(profile.peak().speed <= speed * (1 + kSlack));
    RC_ASSERT(profile.peak().acceleration <= acceleration * (1 + kSlack));
    // One of the limits is used up.
    const bool is_triangle = profile.blend() * 2 >= profile.duration() * (1 - kSlack);
    RC_ASSERT(is_triangle || is_near(profile.peak().speed, speed, speed));
    RC_ASSERT(is_near(profile.peak().acceleration, acceleration, acceleration));
  });
}

TEST(Trapezoid, WithoutAWayTakesNoTime) {
  const auto profile = Trapezoid::fastest(5, 5, 10, 10);
  EXPECT_EQ(profile.duration(), 0);
  EXPECT_EQ(profile.at(0).position, 5);
}

}  // namespace
}  // namespace armjig::motion
