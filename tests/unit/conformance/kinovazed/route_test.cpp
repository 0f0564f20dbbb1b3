// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/route.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <numbers>
#include <random>
#include <vector>

#include "emulators/kinovazed/pose.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using namespace std::chrono_literals;

emulation::Pose pose_of(const Place& place) {
  std::array<float, 6> single{};
  for (std::size_t i = 0; i < single.size(); ++i) single[i] = static_cast<float>(place[i]);
  return {single[0], single[1], single[2], single[3], single[4], single[5]};
}

TEST(Route, HasAPlaceInAFrameWhereTheServerHasIt) {
  std::mt19937 random{7};
  std::uniform_real_distribution<double> any{-1.5, 1.5};
  for (int i = 0; i < 200; ++i) {
    const Place frame{any(random), any(random), any(random), any(random), any(random), any(random)};
    const Place offset{any(random), any(random), any(random),
                       any(random), any(random), any(random)};
    const auto judged = pose_of(in_frame(frame, offset));
    const auto served =
        emulation::transformed(emulation::frame_of(pose_of(frame)), pose_of(offset));
    EXPECT_TRUE(emulation::has_reached(judged, served, {1e-4F, 1e-3F})) << i;
  }
}

constexpr Place kBegin{0.1, 0.1, 0.1, 0, 0, 0};
constexpr Pace kEven{0.2, 1, 0, 0};

Duration time_of(std::span<const Place> points, const Pace& pace = kEven) {
  const std::vector<Leg> legs{{{"Objective", points, false}, 0s}};
  return times_at(pace, kBegin, legs).front();
}

void expect_near(Duration measured, Duration wanted) {
  EXPECT_LT(std::chrono::abs(measured - wanted), 1ms) << measured.count() << " ns";
}

TEST(Route, IsCoveredUntilTheSlowestComponentIsWithinItsReach) {
  constexpr std::array<Place, 1> kStraight{Place{0.6, 0.1, 0.1, 0, 0, 0}};
  expect_near(time_of(kStraight), 2250ms);  // 0.45 m at 0.2 m/s
  constexpr std::array<Place, 1> kTurn{Place{0.1, 0.1, 0.1, 0, 1.25, 0}};
  expect_near(time_of(kTurn), 1s);
  constexpr std::array<Place, 1> kBoth{Place{0.6, 0.1, 0.1, 0, 0, 0.5}};
  expect_near(time_of(kBoth), 2250ms);  // the roll is within its reach half way
  constexpr std::array<Place, 1> kThere{Place{0.14, 0.06, 0.1, 0.2, 0, 0}};
  expect_near(time_of(kThere), 0s);
}

TEST(Route, GoesTheShortWayRoundAndComparesPlainNumbers) {
  constexpr std::array kAcross{Place{0.1, 0.1, 0.1, 3, 0, 0}, Place{0.1, 0.1, 0.1, -3.1, 0, 0}};
  // From 2.75 to half a turn, where the reading changes its sign, and is at once near.
  const std::chrono::duration<double> across{std::numbers::pi - 2.75};
  expect_near(time_of(kAcross), 2750ms + std::chrono::round<Duration>(across));
}

TEST(Route, GoesOnBeyondAWayPointAndRestsAtIt) {
  constexpr std::array kTwice{Place{0.6, 0.1, 0.1, 0, 0, 0}, Place{0.1, 0.1, 0.1, 0, 0, 0}};
  // Back from 0.56: 0.41 m until it is within reach.
  expect_near(time_of(kTwice, {0.2, 1, 0.05, 0.03}), 2250ms + 2050ms + 2 * 80ms);
}

constexpr std::array<Place, 1> kFar{Place{-0.5, 0.2, 0.6, 1, 0, 1}};
constexpr std::array<Place, 1> kNear{Place{0.1, 0.3, 0.2, 1.5, 0, 0}};
constexpr std::array kTurned{Place{0.1, 0.2, 0.3, -1, 1, -1}, Place{0.3, 0.2, 0.3, 0, -1, 1}};
constexpr std::array<Place, 1> kOffset{Place{0.2, -0.1, 0.1, 0.2, 0.3, 0.9}};

std::vector<Leg> tour() {
  const Course far{"Far", kFar, false};
  const Course near{"Near", kNear, false};
  const Course turned{"Turned", kTurned, false};
  const Course offset{"Offset", kOffset, true};
  std::vector<Leg> legs;
  for (const auto& course : {near, far, turned, offset, far, near, offset, turned, near, far}) {
    legs.push_back({course, 0s, !legs.empty()});
  }
  return legs;
}

std::vector<Leg> timed(std::vector<Leg> legs, const Pace& pace) {
  const auto times = times_at(pace, kBegin, legs);
  for (std::size_t i = 0; i < legs.size(); ++i) legs[i].time = times[i];
  return legs;
}

TEST(Route, FindsThePaceThatTimesHave) {
  for (const auto& pace : {Pace{0.05, 0.3, 0.02, 0.05}, Pace{0.2, 1.07, 0.01, 0.04},
                           Pace{0.5, 2, 0.1, 0.2}, Pace{1.5, 5, 0, 0}}) {
    const auto legs = timed(tour(), pace);
    const auto times = times_at(pace_of(kBegin, legs), kBegin, legs);
    for (std::size_t i = 1; i < legs.size(); ++i) {
      EXPECT_LT(std::chrono::abs(times[i] - *legs[i].time), 25ms + *legs[i].time / 100) << i;
    }
  }
}

TEST(Route, FindsThePaceOfTheOthersBesideTimesThatAreWrong) {
  const Pace pace{0.2, 1.07, 0.01, 0.04};
  const auto right = timed(tour(), pace);
  auto legs = right;
  *legs[4].time += 700ms;
  *legs[5].time -= 300ms;
  *legs[9].time += 250ms;
  const auto times = times_at(pace_of(kBegin, legs), kBegin, legs);
  for (std::size_t i = 1; i < legs.size(); ++i) {
    EXPECT_LT(std::chrono::abs(times[i] - *right[i].time), 60ms) << i;
  }
}

TEST(Route, BeginsAgainAfterARunWithoutAnEnd) {
  auto legs = tour();
  legs[2].time.reset();
  const auto times = times_at(kEven, kBegin, legs);
  const std::vector<Leg> alone{legs[3]};
  EXPECT_EQ(times[3], times_at(kEven, kBegin, alone).front());
}

}  // namespace
}  // namespace armjig::kinovazed::conformance
