// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "harness/arm/arm.hpp"

namespace armjig::arm {

struct NumericIkOptions {
  double tolerance_m = 1e-9;
  double tolerance_rad = 1e-9;
  int iterations = 80;     ///< at most, of each attempt
  int attempts = 100;      ///< the first from the seed, the others from drawn postures
  std::uint64_t draw = 1;  ///< another number draws other postures
};

/// What the search has come to. It never takes a bad answer for a good one: `is_reached` says that
/// both tolerances are kept, within the limits.
struct NumericIkAnswer {
  bool is_reached{};
  JointVector joints;  ///< the best found
  double error_m{};
  double error_rad{};
  int attempts{};
  int iterations{};  ///< of all attempts
};

/// Damped least squares within the joints' limits, for any arm. The same arguments give the same
/// answer. Joints that turn for ever come out within half a turn of `seed`.
[[nodiscard]] NumericIkAnswer numeric_ik(const Arm& arm, const Pose& pose,
                                         std::span<const double> seed,
                                         const NumericIkOptions& options = {}) noexcept;

}  // namespace armjig::arm
