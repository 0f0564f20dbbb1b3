// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/latency/probe.hpp"
#include "harness/link/stream_port.hpp"

namespace armjig::parol6::latency {

/// An idle frame, which the board answers with telemetry and does nothing about, but that outputs
/// and gripper go off. Telemetry says how long after the one before the frame was accepted, by the
/// board's own clock: the second witness of when frames left.
[[nodiscard]] Outcome<std::unique_ptr<Probe>> make_probe(StreamPort& port,
                                                         const std::string& target);

/// For recordings of what others asked. Any frame of a command counts, for the board answers each.
[[nodiscard]] std::unique_ptr<Probe> make_listener();

}  // namespace armjig::parol6::latency
