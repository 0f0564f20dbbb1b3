// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>

#include "conformance/morap/chapters.hpp"
#include "conformance/morap/node_bench.hpp"

namespace armjig::morap {
namespace {

using namespace std::chrono_literals;
using enum CommandId;

/// How far the shaft turns in a time, rad.
float turned(NodeBench& node, Duration time) {
  const float before = node.number(kReadAngle);
  node.pause(time);
  return node.number(kReadAngle) - before;
}

template <int sign>
void sense(NodeBench& node) {
  node.send(kVoltage, static_cast<float>(sign) * 1.5F);
  const float angle = turned(node, 300ms);
  node.expect_true(static_cast<float>(sign) * angle > 0.01F, "the shaft to follow the voltage",
                   fmt::format("a turn of {} rad", angle));
  node.send(kDisable);
}

void position(NodeBench& node) {
  node.send(kPosition, 0.5F);
  node.pause(1500ms);
  node.expect_near(kReadAngle, 0.5, 0.03);
  node.send(kDisable);
}

void speed(NodeBench& node) {
  node.send(kSpeed, 1.0F);
  node.pause(500ms);
  const auto begin = node.now();
  const float angle = turned(node, 200ms);
  const double seconds = std::chrono::duration<double>{node.now() - begin}.count();
  const double actual = static_cast<double>(angle) / seconds;
  node.expect_true(std::fabs(actual - 1.0) < 0.1, "a speed of 1 rad/s",
                   fmt::format("{:.3f}", actual));
  node.send(kDisable);
}

void holds(NodeBench& node) {
  node.send(kPosition, 0.5F);
  node.pause(1500ms);
  const float angle = turned(node, 300ms);
  node.expect_true(std::fabs(angle) < 0.01F, "no further turn", fmt::format("{} rad", angle));
  node.send(kDisable);
}

void disabled(NodeBench& node) {
  node.send(kVoltage, 1.5F);
  node.pause(300ms);
  node.send(kDisable);
  node.pause(3s);
  const float angle = turned(node, 300ms);
  node.expect_true(std::fabs(angle) < 0.01F, "a shaft at rest", fmt::format("{} rad", angle));
}

void latched(NodeBench& node) {
  node.send(kCalibrationUnknown);
  node.send(kVoltage, 1.5F);
  const float angle = turned(node, 300ms);
  node.expect_true(std::fabs(angle) < 0.01F, "a shaft at rest", fmt::format("{} rad", angle));
  node.send(kCalibrationUnknown);
}

void current(NodeBench& node) {
  node.send(kVoltage, -1.5F);
  node.pause(8ms + node.noise());
  const float amperes = node.number(kReadCurrent);
  node.expect_true(amperes > 0.02F, "a positive current", fmt::format("{} A", amperes));
  node.send(kDisable);
}

/// A shaft that was driven coasts: a tenth of a second behind it still turns.
template <CommandId brake>
void coasts(NodeBench& node) {
  node.needs_emulation();  // a real gear may stop it as fast as a brake
  node.send(kVoltage, 1.5F);
  node.pause(300ms);
  node.send(kDisable);
  node.send(brake);
  node.pause(100ms);
  const float angle = turned(node, 50ms);
  node.expect_true(angle > 0.002F, "a shaft that coasts", fmt::format("a turn of {} rad", angle));
}

constexpr Case moving(std::string_view requirement, std::string_view rule, void (*run)(Bench&)) {
  return {.requirement = requirement,
          .rule = rule,
          .run = run,
          .hazard = Hazard::kMove,
          .start = kFree};
}

constexpr Case kCases[] = {
    moving("morap.motion.sense", "1.5 V.", on<sense<1>>),
    moving("morap.motion.sense-negative", "-1.5 V.", on<sense<-1>>),
    moving("morap.motion.position", "0.5 rad in 1.5 s.", on<position>),
    moving("morap.motion.speed", "1 rad/s in half a second.", on<speed>),
    moving("morap.motion.holds", "For 0.3 s.", on<holds>),
    moving("morap.motion.disabled", "1.5 V, then 0.", on<disabled>),
    moving("morap.motion.latched", "1.5 V.", on<latched>),
    moving("morap.motion.current", "-1.5 V.", on<current>),
    moving("morap.brake.no-effect", "1.5 V, 0, 15.", on<coasts<kBrake15>>),
    moving("morap.brake.release", "1.5 V, 0, 14.", on<coasts<kBrake14>>),
};

}  // namespace

std::span<const Case> motion_cases() noexcept { return kCases; }

}  // namespace armjig::morap
