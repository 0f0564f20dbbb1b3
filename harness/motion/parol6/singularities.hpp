// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "harness/arm/arm.hpp"
#include "harness/arm/spherical_wrist.hpp"
#include "harness/motion/parol6/planner.hpp"

namespace armjig::parol6::planning {

/// The singularity that a posture is near to, if any: the wrist's centre within 20 mm of the base's
/// axis, the elbow or the wrist within 5 degrees of straight.
[[nodiscard]] std::optional<SingularityNote::Kind> singularity_near(
    const arm::SphericalWrist& solver, const arm::SixJoints& joints) noexcept;

/// Each stretch of a path, a posture each tick, that is near to one.
[[nodiscard]] std::vector<SingularityNote> singularities_on(const arm::Arm& arm,
                                                            const arm::SphericalWrist& solver,
                                                            std::span<const arm::SixJoints> path);

}  // namespace armjig::parol6::planning
