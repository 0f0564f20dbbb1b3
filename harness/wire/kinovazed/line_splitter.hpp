// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "harness/core/bytes.hpp"

namespace armjig::kinovazed {

/// Cuts a byte stream at each LF, for whoever listens to a server. Cutting the stream differently
/// never changes what is found. Memory is fixed; nothing allocates or throws.
class LineSplitter {
 public:
  /// Longer lines are found in pieces of this size, each but the last one without an LF.
  static constexpr std::size_t kLongest = 1152;

  enum class Found : std::uint8_t { kNothing, kLine, kPieceOfLine };
  struct Step {
    std::size_t used{};  ///< bytes of `in` now spoken for; 0 if `in` is empty or with a piece
    Found found{};
    /// Without the LF. Valid until the next `step` and as long as its input.
    std::string_view line;
  };

  /// Reads up to the end of the first line, or as much as a line may hold.
  [[nodiscard]] Step step(Bytes in) noexcept;

  /// The beginning of a line whose end has not come.
  [[nodiscard]] std::string_view held() const noexcept { return {held_.data(), size_}; }

 private:
  std::size_t size_ = 0;
  std::array<char, kLongest> held_{};
};

}  // namespace armjig::kinovazed
