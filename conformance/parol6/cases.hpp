// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "conformance/parol6/board_bench.hpp"
#include "conformance/parol6/chapters.hpp"
#include "conformance/parol6/homing_record.hpp"
#include "conformance/parol6/laws.hpp"
#include "conformance/parol6/motion.hpp"
#include "harness/core/hex.hpp"
#include "harness/wire/parol6/readings.hpp"

/// What the files in chapters/ begin with.
namespace armjig::parol6::conformance {

using namespace std::chrono_literals;
using enum Command;

// Joints, as indices.
inline constexpr std::size_t kJ1 = 0;
inline constexpr std::size_t kJ2 = 1;
inline constexpr std::size_t kJ3 = 2;
inline constexpr std::size_t kJ4 = 3;
inline constexpr std::size_t kJ5 = 4;
inline constexpr std::size_t kJ6 = 5;

}  // namespace armjig::parol6::conformance
