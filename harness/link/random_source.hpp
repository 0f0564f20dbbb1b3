// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace armjig {

/// Random numbers that are the same on every machine, with every compiler and library: the standard
/// fixes its engines but not its distributions, and log() differs in its last bit from one libm to
/// the next. Hence SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators,
/// OOPSLA 2014) and distributions that only add, multiply once and compare.
class RandomSource {
 public:
  explicit constexpr RandomSource(std::uint64_t seed) noexcept : state_{seed} {}

  [[nodiscard]] std::uint64_t next() noexcept;

  /// In [0, 1), a multiple of 2^-53.
  [[nodiscard]] double uniform() noexcept;

  /// 0 to `bound` - 1. Requires `bound` in 1 to 2^53.
  [[nodiscard]] std::uint64_t below(std::uint64_t bound) noexcept;

  /// True with this probability; at 0 never, at 1 always.
  [[nodiscard]] bool happens(double probability) noexcept;

  /// Mean 1, not negative.
  [[nodiscard]] double exponential() noexcept;

  /// Mean 0, standard deviation 1.
  [[nodiscard]] double normal() noexcept;

  /// Another source that depends on `index` and on where this one stands, and is independent of
  /// both.
  [[nodiscard]] RandomSource fork(std::uint64_t index) const noexcept;

 private:
  std::uint64_t state_;
};

}  // namespace armjig
