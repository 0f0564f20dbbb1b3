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
#include "conformance/morap/node_bench.hpp"
#include "conformance/morap/sets.hpp"
#include "emulators/morap/control.hpp"
#include "harness/core/hex.hpp"

/// What the files in cases/ begin with.
namespace armjig::morap::conformance {

using namespace std::chrono_literals;
using enum CommandId;

/// A message and what is then read of programming.
inline void expect_outcome(NodeBench& node, std::string_view message, ProgrammingStatus wanted) {
  node.send_bytes(message);
  node.expect_programming(wanted);
}

}  // namespace armjig::morap::conformance
