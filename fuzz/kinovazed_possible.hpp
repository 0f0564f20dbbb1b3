// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <variant>

#include "emulators/kinovazed/server.hpp"
#include "fuzz/require.hpp"
#include "harness/wire/kinovazed/state.hpp"

namespace armjig::fuzz {

/// Whatever clients do.
inline void require_possible(const kinovazed::emulation::Server& server) {
  constexpr float kFarthest = 1.5;  // m, more than an arm is long
  constexpr float kTurn = 6.3F;
  require(static_cast<std::size_t>(server.state()) < kinovazed::kStateNames.size(),
          "the server is in a state that the table has");
  const auto pose = std::visit([](const auto& arm) { return arm.pose(); }, server.arm().plant());
  for (const auto place : {pose.x, pose.y, pose.z}) {
    require(std::abs(place) <= kFarthest, "the hand is where the arm reaches");
  }
  for (const auto angle : {pose.pitch, pose.yaw, pose.roll}) {
    require(std::abs(angle) <= kTurn, "the hand is turned by less than a turn");
  }
}

}  // namespace armjig::fuzz
