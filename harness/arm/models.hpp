// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "harness/arm/arm.hpp"
#include "harness/arm/orientation.hpp"

/// The arms on our bench. Facts from the vendors' public tables, named in models.cpp.
namespace armjig::arm {

/// PAROL6 as its PC program computes it: the tool (62.8 mm, -45.25 mm, flipped) is part of the last
/// joint.
[[nodiscard]] Arm parol6_commander();

/// PAROL6 as its Python API computes it, up to the flange. The same joint angles; for all of them
/// `parol6_commander` pose = this pose * [Rx(pi), (-45.25, 0, -25.8) mm].
[[nodiscard]] Arm parol6_flange();

/// A tool of the API, in the frame of `parol6_flange`.
struct Parol6Tool {
  std::string_view name;  ///< `none`, `pneumatic-vertical`, `ssg-48` and so on
  Vector3 offset{};
};
[[nodiscard]] std::span<const Parol6Tool> parol6_tools() noexcept;

/// Jaco with six joints, in the angles that the arm reports.
enum class JacoVariant : std::uint8_t {
  kJaco2Curved,  ///< j2n6s300, the default of everything here
  kJaco1Curved,
  kJaco2Spherical,
};
[[nodiscard]] Arm jaco(JacoVariant variant);

/// The arms by name: `parol6`, `parol6-flange`, `jaco2`, `jaco1`, `jaco2-spherical`.
struct ModelEntry {
  std::string_view name;
  std::string_view what;
  Convention convention{};  ///< in which its own programs show orientations
  Arm (*make)();
};
[[nodiscard]] std::span<const ModelEntry> models() noexcept;

}  // namespace armjig::arm
