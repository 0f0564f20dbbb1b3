// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::rig {

/// What the shipped board makes of bytes, as far as a judge has to know: the state table of
/// docs/spec/parol6.md, "Receiving", one byte at a time. The emulated board has a receiver of its
/// own; tests/unit/rig/parol6_laws_test.cpp compares the two.
class ShippedReceiver {
 public:
  /// True if the byte ended a frame that is accepted; see `body`.
  bool take(std::byte byte) noexcept;

  /// What the board unpacks, whatever the length of the last frame was.
  [[nodiscard]] std::span<const std::byte, kCommandBodySize> body() const noexcept {
    return std::span{memory_}.subspan<1, kCommandBodySize>();
  }

 private:
  [[nodiscard]] std::byte& filled() noexcept { return memory_.front(); }
  [[nodiscard]] std::byte& length() noexcept { return memory_.back(); }

  /// As on the board: how much is filled, the store, the length. A store that overflows writes its
  /// own length, and in front of it is what a length of 1 takes for an end byte.
  std::array<std::byte, 1 + kLongestPayload + 1> memory_{};
  std::size_t header_size_ = 0;  ///< how much of a header has come; all of it: in the payload
};

}  // namespace armjig::parol6::rig
