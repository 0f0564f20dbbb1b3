// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "harness/arm/orientation.hpp"
#include "harness/arm/spherical_wrist.hpp"
#include "harness/wire/parol6/frame.hpp"

/// Moves of a PAROL6 as its host programs plan them: from a command and where the joints are to the
/// set-points of every frame. The whole move is computed and checked before its first frame leaves.
/// No I/O.
namespace armjig::parol6::planning {

/// Whose planning.
enum class Rules : std::uint8_t {
  /// The document's, made precise by recordings: ways from step to step, all of a move's samples,
  /// its first and its last included, fractions of a step cut off; straight lines in closed form.
  kDocumented,
  /// The shipped PC program's with its roundings and its slips (docs/motion.md).
  kCommander,
};

enum class Law : std::uint8_t { kPolynomial, kTrapezoid };

/// What the frames of a move tell the board to follow.
enum class Tracking : std::uint8_t {
  kSpeedAndPosition,  ///< `Command::kGoTo`
  kSpeed,             ///< `Command::kJog`
};
[[nodiscard]] constexpr Command command_of(Tracking tracking) noexcept {
  return tracking == Tracking::kSpeed ? Command::kJog : Command::kGoTo;
}

/// What a command says of its time; what it does not say is absent.
struct Timing {
  std::optional<double> speed{};         ///< percent, 0 to 100
  std::optional<double> acceleration{};  ///< percent, 0 to 100
  std::optional<double> duration{};      ///< seconds
  std::optional<Law> law{};
};

struct Move {
  enum class Kind : std::uint8_t {
    kJoint,     ///< six angles, degrees; joints lead
    kPose,      ///< x, y, z in mm, Rx, Ry, Rz in degrees; joints lead
    kLine,      ///< the same, the tool goes straight
    kToolLine,  ///< the same by which the tool moves, in its own frame as it is at the start
  };
  Kind kind{};
  std::array<double, 6> target{};
  Timing timing{};
  Tracking tracking{};
};

/// Where a line cannot be followed, because a joint would have to leap near a singularity.
enum class OnSingularity : std::uint8_t {
  kRefuse,  ///< the move
  kStop,    ///< the arm, at the sample before
  kTry,     ///< go on: a joint that would leap comes as fast as it can, beside the line meanwhile
};

enum class LimitCheck : std::uint8_t {
  kEnforced,
  kIgnored,  ///< for a board that was not homed: its counters are no angles
};

struct PlannerSettings {
  Rules rules = Rules::kDocumented;
  OnSingularity on_singularity = OnSingularity::kStop;  ///< the commander always tries
  LimitCheck limits = LimitCheck::kEnforced;
  /// Of the angles of `kPose` and `kLine`; those of `kToolLine` are `kXyz` with every host.
  arm::Convention convention = arm::Convention::kCommander;
};

/// What one frame tells the joints.
struct SetPoint {
  JointSteps position{};
  JointSpeeds speed{};

  friend bool operator==(const SetPoint&, const SetPoint&) = default;
};

/// Why there is no plan, or why it ends early.
struct Refusal {
  enum class Reason : std::uint8_t {
    kOutOfLimits,          ///< the joint would leave its range: `value`, `limit` in degrees
    kTooFast,              ///< `value`, `limit` in steps/s
    kTooMuchAcceleration,  ///< `value`, `limit` in steps/s^2
    kUnreachable,          ///< no posture has that pose
    kSingular,             ///< the tool cannot follow without a joint that leaps
    kNotConverged,         ///< the commander's inverse kinematics gave up
    kSignFlip,             ///< the commander's guard against a joint that jumps from + to -
    kImpossibleDuration,   ///< `value` in seconds
    kPercentOutOfRange,    ///< `value` in percent
    kBeyondFrame,          ///< a position or speed does not fit into a frame
    kNoTurn,               ///< the commander's turn of the tool is a division by nearly zero
  };
  Reason reason{};
  std::optional<std::size_t> joint{};  ///< from 0
  double value{};
  double limit{};
  double time{};  ///< seconds since the move began

  friend bool operator==(const Refusal&, const Refusal&) = default;
};
/// For people: `j5 would be at 95.100 deg at 1.30 s, its range ends at 90.000 deg`.
[[nodiscard]] std::string describe(const Refusal& refusal);

/// A stretch of a line where the tool cannot move in every direction, followed or not.
struct SingularityNote {
  enum class Kind : std::uint8_t {
    kShoulder,  ///< the wrist's centre is above the base's axis
    kElbow,     ///< the arm is stretched or folded
    kWrist,     ///< axes 4 and 6 are in line
  };
  Kind kind{};
  std::size_t first{};  ///< set-points near it
  std::size_t last{};
  std::size_t nearest{};
  double time{};            ///< seconds since the move began, of the nearest
  arm::SixJoints joints{};  ///< radians, there
  double distance{};        ///< smallest singular value of the Jacobian there
};
[[nodiscard]] std::string describe(const SingularityNote& note);

/// Six joints, one set-point for every frame of the move.
struct Plan {
  std::vector<SetPoint> set_points;  ///< in the order in which they leave, one each 10 ms
  Tracking tracking{};
  Law law{};
  double duration{};            ///< seconds that the law takes
  std::size_t leading_joint{};  ///< from 0: the longest way
  /// Of lines only, in order.
  std::vector<SingularityNote> singularities;
  bool turns_long_way{};  ///< by more than 180 deg, on a line of the commander's
  /// The move ends early, behind the last of `set_points`, and not at its target.
  std::optional<Refusal> stop;
};

/// Requires finite numbers in `move`.
[[nodiscard]] tl::expected<Plan, Refusal> plan(const Move& move, const JointSteps& start,
                                               const PlannerSettings& settings = {});

}  // namespace armjig::parol6::planning
