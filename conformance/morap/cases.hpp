// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/morap/chapters.hpp"
#include "conformance/morap/laws.hpp"
#include "conformance/morap/node_bench.hpp"
#include "conformance/morap/sets.hpp"
#include "harness/core/hex.hpp"

/// What the files in chapters/ begin with.
namespace armjig::morap::conformance {

using namespace std::chrono_literals;
using enum CommandId;

/// A message and what is then read of programming.
inline void expect_outcome(NodeBench& node, std::string_view message, ProgrammingStatus wanted) {
  node.send_bytes(message);
  node.expect_programming(wanted);
}

/// Counts of the encoder, and the angle that they are.
inline void expect_turned(NodeBench& node) {
  node.turn(1000);
  node.expect_bytes(kReadAngle, node.motor().thousand_counts);
}

/// Of a controller that would never run.
inline void expect_of_zero_rate(NodeBench& node, ProgrammingStatus wanted) {
  node.needs_emulation();
  node.send(proportional(0, 1.0F));
  node.expect_programming(wanted);
}

/// Up to the tick at which a loop computes for the first time.
inline void run_loop(NodeBench& node, const ControllerSet& set, float reference) {
  const bool is_speed = set.kind == ControllerKind::kSpeed;
  node.send(set);
  node.send(kCalibrateZero);
  node.tick();
  node.send(is_speed ? kSpeed : kPosition, reference);
  node.tick(set.rate_hz);
}

/// One that gives 16 levels, on a shaft that may turn, and the next tick is far.
inline void run_slow_loop(NodeBench& node) {
  run_loop(node, proportional(node.loop_rate(), 1.0F), 0.75F);
  node.tick();
}

/// Behind the tick that ended a slow loop: what comes now is done at once, for ticks are near.
inline void expect_near_ticks(NodeBench& node) {
  node.settle();
  node.send(kVoltage, 0.75F);
  node.settle();
  node.expect_levels(16);
  node.send(kDisable);
}

/// On any node, with voltages that do its shaft no harm.
constexpr Case slowly(CaseBody run) { return from(kSlow, Hazard::kProgram, run); }

constexpr Case programming(std::string_view rule, CaseBody run, Start start = kProgrammable) {
  return from(start, Hazard::kProgram, rule, run);
}

}  // namespace armjig::morap::conformance
