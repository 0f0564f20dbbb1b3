// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "conformance/kinovazed/route.hpp"
#include "conformance/kinovazed/server_bench.hpp"

namespace armjig::kinovazed::conformance {

/// Runs objectives one after the other, from idle and about `begin` on. Each takes as long as its
/// way is, at the pace of the others; a relative one is done at least once. How fast the arm is
/// does not matter. Skips the case if most of the times have no pace in common, as with an arm that
/// does not go straight or not at an even speed.
void expect_tour(ServerBench& server, const Place& begin, std::span<const Course> courses);

}  // namespace armjig::kinovazed::conformance
