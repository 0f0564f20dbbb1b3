// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/core/error.hpp"

/// A recording of captures/, its host played in real time to an emulated device like the recorded
/// one: over a pseudo-terminal, TCP or an I2C adapter, without a guard.
namespace armjig::testing {

/// What the device said otherwise than recorded, beyond what real time allows; the first of it in
/// words.
struct HostedReplay {
  std::size_t messages{};  ///< none: it cannot be played on this link
  std::size_t differences{};
  std::string first;
};

/// The devices that have recordings.
[[nodiscard]] const std::vector<std::string_view>& recorded_devices();

/// Takes as long as the recording, and twice more if it has to: a machine that stands still for a
/// moment makes two frames one pass, which no rule forgives, so the best of three counts. Problems:
/// those of the file, and of the link.
[[nodiscard]] Outcome<HostedReplay> replay_hosted(std::string_view device, const std::string& file);

}  // namespace armjig::testing
