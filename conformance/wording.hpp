// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/time.hpp"

namespace armjig {

/// For sentences about what was found.
[[nodiscard]] constexpr double milliseconds(Duration time) noexcept {
  return std::chrono::duration<double, std::milli>{time}.count();
}

}  // namespace armjig
