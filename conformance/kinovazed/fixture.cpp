// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/fixture.hpp"

#include <fmt/core.h>

#include <cmath>

namespace armjig::kinovazed::conformance {
namespace {

using namespace std::chrono_literals;

constexpr std::array<std::string_view, 6> kComponents{"x", "y", "z", "pitch", "yaw", "roll"};
constexpr std::size_t kHeight = 2;
/// A place outside what the server takes for a pose: it passes over it, so that it never sees the
/// old components beside the new ones.
constexpr double kNowhere = 2.0;
/// How far beyond the reach a place is that must not count: noise of a reading is 0.0001, and the
/// figures of way-points are known to 0.000001.
constexpr double kBeyond = 0.002;

void glance(ServerBench& server) { server.pause(30ms + 4 * server.noise()); }

/// Around `point`, just too far away in one component at a time.
void pass_by(ServerBench& server, const Place& point) {
  for (std::size_t i = 0; i < point.size(); ++i) {
    for (const int side : {-1, 1}) {
      auto place = point;
      place[i] += side * (reach_of(i) + kBeyond);
      hold_at(server, place);
      glance(server);
    }
  }
}

}  // namespace

Duration look_time(const ServerBench& server) { return 120ms + 6 * server.noise(); }

void hold(ServerBench& server) { server.touch("arm.held", 1); }

void let_go(ServerBench& server) { server.touch("arm.held", 0); }

void hold_at(ServerBench& server, std::size_t component, double value) {
  server.touch(fmt::format("arm.at.{}", kComponents[component]), std::llround(value * 1e6));
}

void hold_at(ServerBench& server, const Place& place) {
  hold(server);
  hold_at(server, kHeight, kNowhere);
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (i != kHeight) hold_at(server, i, place[i]);
  }
  hold_at(server, kHeight, place[kHeight]);
}

void visit(ServerBench& server, const Place& place) {
  hold_at(server, place);
  server.pause(look_time(server));
}

Place near(const Place& place, double share) {
  auto moved = place;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    moved[i] += (i % 2 == 0 ? share : -share) * reach_of(i);
  }
  return moved;
}

void expect_points(ServerBench& server, std::string_view objective, const Place& first,
                   std::span<const Place> points) {
  constexpr double kJustThere = 0.94;
  for (std::size_t i = 0; i < points.size() && !server.is_over(); ++i) {
    const auto rest = points.subspan(i);
    visit(server, first);
    server.accept(fmt::format("RunObjective:{}", objective));
    server.pause(look_time(server));
    for (const auto& point : points.first(i)) visit(server, point);
    server.about(fmt::format("{}, too far from its way-point {}", objective, i + 1));
    pass_by(server, rest.front());
    for (const auto& point : rest.subspan(1)) visit(server, point);
    server.expect_quiet(look_time(server));
    server.about(fmt::format("{}, way-points from {} on", objective, i + 1));
    const double share = i % 2 == 0 ? kJustThere : -kJustThere;
    for (const auto& point : rest) visit(server, near(point, share));
    server.expect(Event::kObjectiveDone);
  }
}

}  // namespace armjig::kinovazed::conformance
