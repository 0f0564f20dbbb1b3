// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <ranges>
#include <vector>

#include "harness/core/bytes.hpp"

namespace armjig::sessions {

/// Draws the same numbers with every compiler and library, which the distributions of the standard
/// library do not. Two draws that are arguments of one function come in any order: only braces
/// keep it (`Words`).
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_{seed} {}
  /// Loaded: what falls is in these bytes, as many for each draw as its choices need. They outlive
  /// the dice. Behind them it is chance again, the same each time.
  explicit Dice(Bytes choices) : is_loaded_{true}, choices_{choices} {}

  /// Loaded, and all bytes are used up.
  [[nodiscard]] bool is_over() const noexcept { return is_loaded_ && choices_.empty(); }

  /// From `least` to `most`, both included.
  [[nodiscard]] std::int64_t between(std::int64_t least, std::int64_t most) {
    const auto choices = static_cast<std::uint64_t>(most) - static_cast<std::uint64_t>(least) + 1;
    const auto any = choices_.empty() ? engine_() : take((std::bit_width(choices - 1) + 7) / 8);
    const auto drawn = choices == 0 ? any : any % choices;
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(least) + drawn);
  }
  /// The same in the type that is wanted.
  template <class Integer>
  [[nodiscard]] Integer number(std::int64_t least, std::int64_t most) {
    return static_cast<Integer>(between(least, most));
  }
  /// More often near `least` than near `most`: as often below a hundredth of the way as above half.
  [[nodiscard]] std::int64_t mostly_low(std::int64_t least, std::int64_t most) {
    const auto way = between(0, 1000);
    return least + (most - least) / 1000 * way / 1000 * way / 1000 * way;
  }
  [[nodiscard]] bool one_in(std::int64_t chances) { return between(1, chances) == 1; }
  [[nodiscard]] std::byte byte() { return number<std::byte>(0, 255); }
  [[nodiscard]] std::vector<std::byte> bytes(std::int64_t least, std::int64_t most) {
    std::vector<std::byte> drawn(number<std::size_t>(least, most));
    std::ranges::generate(drawn, [this] { return byte(); });
    return drawn;
  }

  /// One element of a range that is not empty.
  template <std::ranges::random_access_range Range>
  [[nodiscard]] auto& one_of(Range&& range) {
    return range[number<std::size_t>(0, std::ssize(range) - 1)];
  }

  /// One element; how often is what `weight` says of each. One of them is not 0.
  template <std::ranges::forward_range Range, class Weight>
  [[nodiscard]] const auto& weighted(const Range& range, Weight weight) {
    std::int64_t all = 0;
    for (const auto& one : range) all += std::invoke(weight, one);
    auto left = between(0, all - 1);
    auto found = std::ranges::begin(range);
    while (left >= std::invoke(weight, *found)) left -= std::invoke(weight, *found++);
    return *found;
  }

 private:
  /// The next so many bytes as a number.
  [[nodiscard]] std::uint64_t take(std::size_t size) {
    std::uint64_t number = 0;
    const auto taken = choices_.first(std::min(size, choices_.size()));
    for (const auto byte : taken) number = number << 8 | std::to_integer<std::uint64_t>(byte);
    choices_ = choices_.subspan(taken.size());
    return number;
  }

  bool is_loaded_ = false;
  Bytes choices_;
  std::mt19937_64 engine_;
};

}  // namespace armjig::sessions
