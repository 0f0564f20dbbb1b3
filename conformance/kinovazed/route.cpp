// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/route.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

namespace armjig::kinovazed::conformance {
namespace {

double within_half_a_turn(double angle) noexcept {
  return std::remainder(angle, 2 * std::numbers::pi);
}

Eigen::Isometry3d pose_of(const Place& place) noexcept {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return Eigen::Translation3d{place[0], place[1], place[2]} *
         AngleAxisd{place[3], Vector3d::UnitX()} * AngleAxisd{place[4], Vector3d::UnitY()} *
         AngleAxisd{place[5], Vector3d::UnitZ()};
}

/// The share of the way after which one component counts as reached, which the server compares as
/// a plain number: what goes the short way past half a turn is not there before it has passed it.
double share_until_reached(double from, double way, std::size_t component) noexcept {
  const double end = from + way;
  const bool passes_half_a_turn = component >= 3 && std::abs(end) > std::numbers::pi;
  const double half_a_turn = std::copysign(std::numbers::pi, end);
  const double passes = passes_half_a_turn ? (half_a_turn - from) / way : 0;
  const double nears = way == 0 ? 0 : 1 - reach_of(component) / std::abs(way);
  return std::max({0.0, nears, passes});
}

double seconds(Duration time) noexcept { return std::chrono::duration<double>{time}.count(); }

/// An arm under way.
class Hand {
 public:
  Hand(const Place& place, const Pace& pace) noexcept : place_{place}, pace_{pace} {}

  [[nodiscard]] const Place& place() const noexcept { return place_; }

  /// Goes there in a straight line until that counts as reached, and on for as long as nobody stops
  /// it. Seconds until then.
  double approach(const Place& target) noexcept {
    Place way{};
    double reached = 0;
    for (std::size_t i = 0; i < way.size(); ++i) {
      const double difference = target[i] - place_[i];
      way[i] = i < 3 ? difference : within_half_a_turn(difference);
      reached = std::max(reached, share_until_reached(place_[i], way[i], i));
    }
    const double whole = seconds_of(way);
    const double share = whole > 0 ? std::min(1.0, reached + pace_.seconds_beyond / whole) : 1;
    for (std::size_t i = 0; i < way.size(); ++i) {
      place_[i] += share * way[i];
      if (i >= 3) place_[i] = within_half_a_turn(place_[i]);
    }
    return reached * whole + pace_.seconds_beyond;
  }

 private:
  [[nodiscard]] double seconds_of(const Place& way) const noexcept {
    return std::max(std::hypot(way[0], way[1], way[2]) / pace_.metres_per_second,
                    std::max({std::abs(way[3]), std::abs(way[4]), std::abs(way[5])}) /
                        pace_.radians_per_second);
  }

  Place place_;
  Pace pace_;
};

double follow(Hand& hand, const Course& course) noexcept {
  const auto frame = hand.place();
  double sum = 0;
  for (const auto& point : course.points) {
    sum += hand.approach(course.is_relative ? in_frame(frame, point) : point);
  }
  return sum;
}

/// Seconds in motion, of each leg.
std::vector<double> motions(const Pace& pace, const Place& begin, std::span<const Leg> legs) {
  std::vector<double> all;
  Hand hand{begin, pace};
  for (const auto& leg : legs) {
    all.push_back(follow(hand, leg.course));
    if (!leg.time) hand = Hand{begin, pace};
  }
  return all;
}

/// Of a pace how badly legs fit, none of them counting for more than `most` seconds; its
/// `seconds_per_point` becomes the middle one of what legs take besides their motion.
double misfit(Pace& pace, const Place& begin, std::span<const Leg> legs, double most) {
  const auto moving = motions(pace, begin, legs);
  std::vector<double> rests;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (!legs[i].counts()) continue;
    rests.push_back((seconds(*legs[i].time) - moving[i]) /
                    static_cast<double>(legs[i].course.points.size()));
  }
  if (rests.empty()) return 0;
  const auto middle = rests.begin() + static_cast<std::ptrdiff_t>(rests.size() / 2);
  std::ranges::nth_element(rests, middle);
  pace.seconds_per_point = std::max(0.0, *middle);
  double sum = 0;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (!legs[i].counts()) continue;
    const double due =
        moving[i] + pace.seconds_per_point * static_cast<double>(legs[i].course.points.size());
    sum += std::min(most, std::abs(seconds(*legs[i].time) - due));
  }
  return sum;
}

/// A grid of paces around one.
struct Grid {
  double step;         ///< factor between neighbouring speeds
  int speeds;          ///< so many to each side
  double beyond_step;  ///< in seconds
  int beyonds;         ///< to each side
  double most;         ///< what a leg counts for at most, in seconds
};

Pace best_in(const Grid& grid, const Pace& centre, const Place& begin, std::span<const Leg> legs) {
  auto best = centre;
  double least = std::numeric_limits<double>::infinity();
  for (int i = -grid.speeds; i <= grid.speeds; ++i) {
    for (int j = -grid.speeds; j <= grid.speeds; ++j) {
      for (int k = -grid.beyonds; k <= grid.beyonds; ++k) {
        Pace pace{centre.metres_per_second * std::pow(grid.step, i),
                  centre.radians_per_second * std::pow(grid.step, j),
                  std::max(0.0, centre.seconds_beyond + k * grid.beyond_step), 0};
        const double misfits = misfit(pace, begin, legs, grid.most);
        if (misfits >= least) continue;
        least = misfits;
        best = pace;
      }
    }
  }
  return best;
}

}  // namespace

Place in_frame(const Place& frame, const Place& offset) noexcept {
  const Eigen::Isometry3d pose = pose_of(frame) * pose_of(offset);
  const auto& turned = pose.linear();
  const Eigen::Vector3d at = pose.translation();
  return {at.x(),
          at.y(),
          at.z(),
          std::atan2(-turned(1, 2), turned(2, 2)),
          std::asin(std::clamp(turned(0, 2), -1.0, 1.0)),
          std::atan2(-turned(0, 1), turned(0, 0))};
}

std::vector<Duration> times_at(const Pace& pace, const Place& begin, std::span<const Leg> legs) {
  std::vector<Duration> times;
  const auto moving = motions(pace, begin, legs);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const double rest = pace.seconds_per_point * static_cast<double>(legs[i].course.points.size());
    times.push_back(
        std::chrono::duration_cast<Duration>(std::chrono::duration<double>{moving[i] + rest}));
  }
  return times;
}

Pace pace_of(const Place& begin, std::span<const Leg> legs) {
  // The middle of each range, and finer grids around the best of the one before.
  Pace pace{0.2, 0.84, 0.02, 0};
  for (const auto& grid : {Grid{1.1, 24, 0, 0, 1.0}, Grid{1.03, 5, 0.04, 4, 0.3},
                           Grid{1.01, 4, 0.01, 4, 0.1}, Grid{1.003, 4, 0.003, 3, 0.05}}) {
    pace = best_in(grid, pace, begin, legs);
  }
  return pace;
}

}  // namespace armjig::kinovazed::conformance
