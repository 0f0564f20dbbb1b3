// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/device.hpp"
#include "conformance/bench.hpp"

namespace armjig::cli {

/// Plays sessions to a new emulated device like `target` and, beside it, to one of `reference` that
/// has no fault, in virtual time: nothing may differ. All three outlive it.
[[nodiscard]] PlaySessions sessions_beside(const Device& device, const Target& target,
                                           const Device& reference);

}  // namespace armjig::cli
