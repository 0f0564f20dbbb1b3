// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "cli/device.hpp"
#include "conformance/bench.hpp"

namespace armjig::cli {

/// By then what was found is as short as it becomes. No clock has a part in it.
inline constexpr std::size_t kMostAttempts = 500;

/// Plays sessions to a new emulated device like `target` and, beside it, to one of `reference` that
/// has no fault, in virtual time: nothing may differ. All three outlive it. What differs is made
/// shorter, with so many attempts at most.
[[nodiscard]] PlaySessions sessions_beside(const Device& device, const Target& target,
                                           const Device& reference,
                                           std::size_t most_attempts = kMostAttempts);

}  // namespace armjig::cli
