// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/latency/follower.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::parol6::latency {

/// The first joint of an emulated board, led by go-to frames with feed forward, as host programs
/// do. It need not be homed for that.
[[nodiscard]] Outcome<std::unique_ptr<Follower>> make_follower(Rig<StreamPort> rig);

}  // namespace armjig::parol6::latency
