// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <tl/expected.hpp>

#include "harness/arm/jacobian.hpp"
#include "harness/motion/parol6/planner.hpp"

namespace armjig::parol6::planning {

enum class JogFrame : std::uint8_t { kWorld, kTool };

/// How the tool shall move while a key is held: m/s and rad/s along and about the axes of a frame,
/// about the tool's own origin.
struct CartesianJog {
  JogFrame frame{};
  arm::Twist velocity{};
};

/// What the vendor's program can be set to, for tools that ask.
inline constexpr double kSlowestToolJog = 0.002;  // m/s
inline constexpr double kFastestToolJog = 0.06;   // m/s
inline constexpr double kSlowestToolTurn = 0.7;   // deg/s
inline constexpr double kFastestToolTurn = 25;    // deg/s

/// Turns what the tool shall do into what the joints do. Nothing of it is on the heap.
class CartesianJogger {
 public:
  CartesianJogger();

  /// The joints' speeds for the next frame, for `Command::kJog`, from where the joints are now.
  /// Refused if the tool cannot move that way there (`kSingular`), a joint would have to be
  /// faster than it jogs (`kTooFast`), or it is at its limit and would go beyond (`kOutOfLimits`).
  [[nodiscard]] tl::expected<JointSpeeds, Refusal> speeds(const CartesianJog& jog,
                                                          const JointSteps& now) const noexcept;

 private:
  arm::Arm arm_;
};

}  // namespace armjig::parol6::planning
