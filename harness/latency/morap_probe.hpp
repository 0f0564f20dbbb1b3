// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/latency/probe.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig::morap::latency {

/// The address of the first node that answers. Problems: as for `make_probe`.
[[nodiscard]] Outcome<BusAddress> first_node(BusPort& port, const std::string& target);

/// The angle of the first node that answers: a write of one byte, then a read of four. Problems:
/// nobody answers (`kTimedOut`), trouble with the bus. `target` is for messages.
[[nodiscard]] Outcome<std::unique_ptr<Probe>> make_probe(BusPort& port, const std::string& target);

/// For recordings of what others asked. Any choice of what to read, of one node or several, and the
/// read that follows it.
[[nodiscard]] std::unique_ptr<Probe> make_listener();

}  // namespace armjig::morap::latency
