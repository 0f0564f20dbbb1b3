// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>

#include "harness/wire/morap/controller_set.hpp"

/// Controllers that are easy to reckon with.
namespace armjig::morap::conformance {

inline Coefficients filter(std::initializer_list<float> values) {
  Coefficients filter{static_cast<std::uint8_t>(values.size())};
  std::ranges::copy(values, filter.values.begin());
  return filter;
}

/// One that answers a reference with `gain` times as many volts and minds nothing else.
inline ControllerSet proportional(std::uint16_t rate_hz, float gain,
                                  ControllerKind kind = ControllerKind::kPosition) {
  return {kind, rate_hz, filter({0.0F}), filter({gain}), filter({0.0F}), 0.0F};
}

}  // namespace armjig::morap::conformance
