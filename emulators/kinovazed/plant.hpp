// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "emulators/kinovazed/pose.hpp"

/// What a Jaco arm and whoever drives it have in common, however the arm is simulated.
namespace armjig::kinovazed::emulation {

/// The retraction mode as the arm reports it. Values without a name keep their number.
enum class ArmMode : std::int32_t {
  kToReady = 0,
  kReady = 1,
  kReadyToFolded = 2,
  kFolded = 3,
  kFoldedToReady = 4,
  kElsewhere = 5,
  kNeverHomed = 6,
  kError = 25000,
};

enum class Control : std::uint8_t { kCartesian, kAngular };

/// Stick axes, 1 being full deflection: left-right, front-back, twist.
struct Stick {
  std::array<float, 3> translation{};
  std::array<float, 3> wrist{};

  friend bool operator==(const Stick&, const Stick&) = default;
};

/// Small, fast, and the same on every machine (xorshift64*).
class Noise {
 public:
  explicit Noise(std::uint64_t seed) noexcept : state_{seed | 1} {}

  /// Uniform in [-1, 1).
  [[nodiscard]] float next() noexcept {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    const auto bits = static_cast<std::int32_t>(state_ * UINT64_C(0x2545F4914F6CDD1D) >> 40);
    return static_cast<float>(bits - (1 << 23)) / static_cast<float>(1 << 23);
  }

 private:
  std::uint64_t state_;
};

}  // namespace armjig::kinovazed::emulation
