// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "cli/device.hpp"
#include "conformance/bench.hpp"

namespace armjig::cli {

struct BesideHow {
  /// What differs is made shorter, with so many attempts at most: by then it is as short as it
  /// becomes. No clock has a part in it.
  std::size_t most_attempts = 500;
  /// What is beside the link is done, too, so that not all of a session is bytes.
  bool has_hands = true;
  /// A server is told that a client closed; a system tells it only that nothing more comes.
  bool are_ends_told = true;
  /// What differs in time alone by no more is equal, and so is what one comes past in that time.
  Duration tolerance{};
};

/// Plays sessions to a new emulated device like `target` and, beside it, to one of `reference` that
/// has no fault, in virtual time: nothing may differ. All three outlive it.
[[nodiscard]] PlaySessions sessions_beside(const Device& device, const Target& target,
                                           const Device& reference, const BesideHow& beside = {});

}  // namespace armjig::cli
