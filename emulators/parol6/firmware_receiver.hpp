// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "harness/core/bytes.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::emulation {

/// The receiver of the shipped board with all its quirks (docs/spec/parol6.md, "Receiving"): any
/// length byte is believed, the check byte is not looked at, nothing times out, and the store keeps
/// what earlier frames left in it. Cutting the stream differently never changes what is accepted.
class FirmwareReceiver {
 public:
  struct Step {
    std::size_t used{};  ///< 0 only if the input is empty
    bool accepted{};     ///< a frame ended with the last used byte; see `body`
  };

  /// Reads up to the end of the first accepted frame, or all of `in`.
  [[nodiscard]] Step step(Bytes in) noexcept;

  /// What the board unpacks, whatever the length of the last frame was.
  [[nodiscard]] std::span<const std::byte, kCommandBodySize> body() const noexcept {
    return std::span{store_}.first<kCommandBodySize>();
  }

 private:
  [[nodiscard]] std::size_t read_header(Bytes in) noexcept;
  [[nodiscard]] Step read_payload(Bytes in) noexcept;
  [[nodiscard]] bool ends_well() const noexcept;
  void expect_header() noexcept;

  std::array<std::byte, kLongestPayload> store_{};
  std::uint8_t start_bytes_ = 0;  ///< how many of the three have come
  bool in_payload_ = false;
  std::uint8_t length_ = 0;
  std::uint8_t filled_ = 0;
};

}  // namespace armjig::parol6::emulation
