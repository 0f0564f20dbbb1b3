// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/link/session_port.hpp"
#include "harness/rig/target.hpp"

namespace armjig {

/// A KinovaZED server in this process, on virtual time, as its only client has it. Problems: those
/// of its options.
[[nodiscard]] Outcome<std::unique_ptr<SessionPort>> open_kinovazed_session(const Target& target);

}  // namespace armjig
