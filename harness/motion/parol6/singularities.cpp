// SPDX-License-Identifier: Apache-2.0
#include "harness/motion/parol6/singularities.hpp"

#include <cstddef>

#include "harness/arm/jacobian.hpp"
#include "harness/motion/parol6/joint_table.hpp"

namespace armjig::parol6::planning {

std::optional<SingularityNote::Kind> singularity_near(const arm::SphericalWrist& solver,
                                                      const arm::SixJoints& joints) noexcept {
  constexpr double kNearAxis = 0.02;         // m
  constexpr double kNearStraight = 0.08716;  // sine of 5 degrees
  const auto clearance = solver.clearance(joints);
  if (clearance.wrist < kNearStraight) return SingularityNote::Kind::kWrist;
  if (clearance.elbow < kNearStraight) return SingularityNote::Kind::kElbow;
  if (clearance.shoulder < kNearAxis) return SingularityNote::Kind::kShoulder;
  return std::nullopt;
}

std::vector<SingularityNote> singularities_on(const arm::Arm& arm,
                                              const arm::SphericalWrist& solver,
                                              std::span<const arm::SixJoints> path) {
  std::vector<SingularityNote> notes;
  std::optional<SingularityNote::Kind> before;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const auto kind = singularity_near(solver, path[k]);
    const bool goes_on = kind == before;
    before = kind;
    if (!kind) continue;
    const SingularityNote here{
        .kind = *kind,
        .first = k,
        .last = k,
        .nearest = k,
        .time = kTick * static_cast<double>(k),
        .joints = path[k],
        .distance = dexterity(arm::jacobian(arm, path[k])).smallest_singular_value};
    if (!goes_on) {
      notes.push_back(here);
      continue;
    }
    auto& note = notes.back();
    const auto first = note.first;
    if (here.distance < note.distance) note = here;
    note.first = first;
    note.last = k;
  }
  return notes;
}

}  // namespace armjig::parol6::planning
