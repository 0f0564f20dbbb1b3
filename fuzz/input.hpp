// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "harness/core/bytes.hpp"

namespace armjig::fuzz {

/// What a fuzzer gives, taken piece by piece. What it does not say is 0.
class Input {
 public:
  explicit Input(Bytes rest) noexcept : rest_{rest} {}

  [[nodiscard]] bool is_empty() const noexcept { return rest_.empty(); }

  std::uint8_t u8() noexcept {
    if (rest_.empty()) return 0;
    const auto value = std::to_integer<std::uint8_t>(rest_[0]);
    rest_ = rest_.subspan(1);
    return value;
  }
  std::int16_t i16() noexcept {
    const auto high = u8();
    return static_cast<std::int16_t>(high << 8 | u8());
  }
  /// Up to `most` bytes.
  Bytes bytes(std::size_t most) noexcept {
    const auto taken = rest_.first(std::min(most, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }

 private:
  Bytes rest_;
};

}  // namespace armjig::fuzz
