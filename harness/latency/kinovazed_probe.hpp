// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/latency/probe.hpp"
#include "harness/link/session_source.hpp"

namespace armjig::kinovazed::latency {

/// Unfreeze, which is Rejected and does nothing but in an arm that is frozen: so it needs
/// permission to change the state. Heartbeats are listened to on the side.
[[nodiscard]] Outcome<std::unique_ptr<Probe>> make_probe(SessionSource& port,
                                                         const std::string& target);

/// For recordings of what others asked. Any command that is answered; and how long until what it
/// began was done.
[[nodiscard]] std::unique_ptr<Probe> make_listener();

}  // namespace armjig::kinovazed::latency
