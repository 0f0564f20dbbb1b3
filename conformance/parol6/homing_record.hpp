// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "conformance/parol6/board_bench.hpp"
#include "conformance/parol6/laws.hpp"

namespace armjig::parol6::conformance {

/// What telemetry showed of a whole run of homing, cut at changes of the homed bits.
class HomingRecord {
 public:
  /// `log`: answers of one run in order, the first from before it.
  explicit HomingRecord(const std::vector<Answer>& log) : log_{log} {}

  /// Answers since home acted, with these homed bits.
  [[nodiscard]] std::vector<Answer> with_bits(std::uint8_t homed) const;
  /// Of those, the first unbroken stretch in which the joint has that speed: a ramp later on may
  /// pass through it by chance.
  [[nodiscard]] std::vector<Answer> with_speed(std::uint8_t homed, std::size_t joint,
                                               int speed) const;
  /// The values of homed, without repetitions.
  [[nodiscard]] std::vector<std::uint8_t> bits() const;
  /// The first answer since home acted.
  [[nodiscard]] const Answer& first() const { return log_.at(1); }
  [[nodiscard]] const Answer& last() const { return log_.back(); }

 private:
  const std::vector<Answer>& log_;
};

/// What a run sets in its first pass.
[[nodiscard]] constexpr Speeds seek_speeds() noexcept {
  Speeds speeds{};
  for (std::size_t j = 0; j < kJointCount; ++j) speeds[j] = kHoming[j].seek;
  return speeds;
}

inline constexpr std::uint8_t kNoneHomed = 0x03;
inline constexpr std::uint8_t kFirstThreeHomed = 0xE3;
inline constexpr std::uint8_t kFirstFourHomed = 0xF3;
inline constexpr std::uint8_t kAllHomed = 0xFF;

}  // namespace armjig::parol6::conformance
