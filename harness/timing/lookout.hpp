// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

namespace armjig {

/// Notices that a loop which should look at the world again and again did not: its process was
/// stopped, its machine had no time for it, or it was busy. The caller says what time it is.
class Lookout {
 public:
  using Wall = std::chrono::steady_clock;

  /// A time in which nobody looked.
  struct Gap {
    Wall::time_point from;
    Wall::time_point to;

    friend bool operator==(const Gap&, const Gap&) = default;
  };

  /// `longest`: between two looks, without it being a gap.
  Lookout(Wall::duration longest, Wall::time_point start) noexcept
      : longest_{longest}, last_{start} {}

  /// Looks. The gap that ends here, if there is one.
  [[nodiscard]] std::optional<Gap> look(Wall::time_point now) noexcept {
    const Gap gap{last_, now};
    last_ = now;
    return gap.to - gap.from > longest_ ? std::optional{gap} : std::nullopt;
  }

 private:
  Wall::duration longest_;
  Wall::time_point last_;
};

}  // namespace armjig
