// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "emulators/morap/node.hpp"
#include "fuzz/require.hpp"

namespace armjig::fuzz {

/// Whatever a master does.
inline void require_possible(const morap::emulation::Node& node) {
  const auto is_one_of_three = [](auto status) {
    const auto value = static_cast<unsigned>(status);
    return value >= 1 && value <= 3;
  };
  require(is_one_of_three(node.status()), "the motor is in a state that the table has");
  require(is_one_of_three(node.programming_status()),
          "programming is in a state that the table has");
  require(std::isfinite(node.angle()), "a shaft has an angle");
}

}  // namespace armjig::fuzz
