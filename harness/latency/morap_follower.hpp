// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/latency/follower.hpp"
#include "harness/link/bus_port.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::morap::latency {

/// The first node of an emulated bus with its default controllers, led by position references; its
/// unit is the count of its encoder. Problems: nobody is on the bus.
[[nodiscard]] Outcome<std::unique_ptr<Follower>> make_follower(Rig<BusPort> rig);

}  // namespace armjig::morap::latency
