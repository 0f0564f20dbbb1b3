// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "emulators/parol6/firmware_receiver.hpp"
#include "emulators/parol6/profile.hpp"
#include "harness/core/bytes.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "harness/wire/parol6/splitter.hpp"

namespace armjig::parol6::emulation {

/// Finds the frames that a board of some profile accepts. Cutting the stream differently never
/// changes what is accepted.
class CommandReceiver {
 public:
  using Body = std::span<const std::byte, kCommandBodySize>;
  struct Step {
    std::size_t used{};        ///< 0 only if the input is empty
    std::optional<Body> body;  ///< of the frame that ended with the last used byte, until the next
                               ///< step and as long as its input
  };

  explicit CommandReceiver(const BoardProfile& profile) noexcept
      : resynchronises_{profile.resynchronises},
        check_{profile.check},
        strict_{kCommandPayloadSize, profile.check} {}

  /// Reads up to the end of the first accepted frame, or all of `in`.
  [[nodiscard]] Step step(Bytes in) noexcept {
    return resynchronises_ ? step_strictly(in) : step_as_shipped(in);
  }

 private:
  [[nodiscard]] Step step_strictly(Bytes in) noexcept;
  [[nodiscard]] Step step_as_shipped(Bytes in) noexcept;

  bool resynchronises_;
  CheckPolicy check_;
  FirmwareReceiver shipped_;
  Splitter strict_;
};

}  // namespace armjig::parol6::emulation
