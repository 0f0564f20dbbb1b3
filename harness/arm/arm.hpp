// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "harness/arm/joint_vector.hpp"
#include "harness/arm/pose.hpp"

/// Kinematics of serial arms. Metres, radians, seconds; no I/O.
namespace armjig::arm {

struct Joint {
  enum class Kind : std::uint8_t { kRevolute, kPrismatic };

  std::string name;
  Kind kind = Kind::kRevolute;
  Pose origin{};          ///< of the joint's frame in the frame before it, at 0
  Vector3 axis{0, 0, 1};  ///< of length 1, in the joint's frame; turns or slides along it
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double max_speed = std::numeric_limits<double>::infinity();  ///< rad/s or m/s

  /// Turns for ever, both ways.
  [[nodiscard]] bool is_continuous() const noexcept {
    return lower == -std::numeric_limits<double>::infinity();
  }
};

/// A chain of at most `kMaxJoints` moving joints between base and tool.
struct Arm {
  std::string name;
  std::vector<Joint> joints;
  Pose tool{};  ///< in the last joint's frame: flange and what is mounted on it

  [[nodiscard]] std::size_t joint_count() const noexcept { return joints.size(); }
};

/// The same arm with a tool mounted on its present tool frame.
[[nodiscard]] Arm with_tool(Arm arm, const Pose& tool);

/// The same arm with joints that move without end.
[[nodiscard]] Arm without_limits(Arm arm);

/// A row of a Denavit-Hartenberg table in the classic form Rz(theta) Tz(d) Tx(a) Rx(alpha), where
/// theta = sign * joint + offset.
struct DhRow {
  double d{};
  double a{};
  double alpha{};
  double sign = 1;
  double offset = 0;
};

/// Joints turn without limit and are called j1, j2 and so on. Requires `rows.size() <= kMaxJoints`.
[[nodiscard]] Arm arm_from_dh(std::string name, std::span<const DhRow> rows, const Pose& base = {});

/// The first joint that is not within its limits, or `joint_count()`. The limits themselves are
/// within.
[[nodiscard]] std::size_t first_outside(const Arm& arm, std::span<const double> joints) noexcept;

/// Requires `joints.size() == arm.joint_count()`, here and below.
[[nodiscard]] Pose forward(const Arm& arm, std::span<const double> joints) noexcept;

/// The frame behind each joint, and last the tool's: `joint_count() + 1` poses in the base's frame.
void forward_all(const Arm& arm, std::span<const double> joints, std::span<Pose> frames) noexcept;

}  // namespace armjig::arm
