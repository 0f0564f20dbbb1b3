// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/morap/cases.hpp"

/// What the cases about feedback loops have in common.
namespace armjig::morap::conformance {

inline constexpr std::uint16_t kRate = kIdleRateHz;

inline ControllerSet position_set(std::initializer_list<float> d, std::initializer_list<float> c,
                                  std::initializer_list<float> f, float integral = 0.0F,
                                  std::uint16_t rate_hz = kRate) {
  return {ControllerKind::kPosition, rate_hz, filter(d), filter(c), filter(f), integral};
}

/// One that minds nothing but its reference, so that it does not matter where the shaft is.
inline ControllerSet blind_set(NodeBench& node, std::initializer_list<float> c,
                               std::initializer_list<float> f, float integral = 0.0F) {
  return position_set({0.0F}, c, f, integral, node.loop_rate());
}

/// Far from where any shaft is, and the gain of an integrator small for it: a shaft that turns
/// meanwhile is as good as one at rest.
inline constexpr float kFar = 75.0F;

/// Whose output grows by four levels at each tick.
inline void run_integrator(NodeBench& node) {
  run_loop(node, blind_set(node, {0.0F}, {0.0F}, 0.0025F), kFar);
}

constexpr Case loop(std::string_view rule, CaseBody run) {
  return from(kFresh, Hazard::kProgram, rule, run);
}

}  // namespace armjig::morap::conformance
