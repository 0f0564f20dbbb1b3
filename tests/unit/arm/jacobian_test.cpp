// SPDX-License-Identifier: Apache-2.0
#include "harness/arm/jacobian.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "harness/arm/models.hpp"
#include "harness/arm/spherical_wrist.hpp"
#include "tests/unit/arm/degrees.hpp"

namespace armjig::arm {
namespace {

using test::radians;

TEST(Jacobian, IsTheDerivativeOfForwardKinematics) {
  constexpr double kSmall = 1e-6;
  for (const auto& entry : models()) {
    const auto arm = entry.make();
    const auto joints = radians({10, -60, 200, 20, -30, 100});
    const auto columns = jacobian(arm, joints);
    const auto here = forward(arm, joints);
    for (std::size_t j = 0; j < 6; ++j) {
      auto moved = joints;
      moved[j] += kSmall;
      const auto there = forward(arm, moved);
      const auto linear = 1 / kSmall * (there.position - here.position);
      const auto angular = 1 / kSmall * rotation_vector(there.rotation * inverse(here.rotation));
      EXPECT_LT(norm(columns[j].linear - linear), 1e-5) << entry.name << " j" << j + 1;
      EXPECT_LT(norm(columns[j].angular - angular), 1e-5) << entry.name << " j" << j + 1;
    }
  }
}

TEST(Dexterity, IsZeroWhereTheWristIsStraight) {
  const auto arm = parol6_commander();
  const auto straight = dexterity(jacobian(arm, radians({20, -70, 190, 35, 0, 120})));
  EXPECT_LT(straight.manipulability, 1e-12);
  EXPECT_LT(straight.smallest_singular_value, 1e-12);
  const auto bent = dexterity(jacobian(arm, radians({20, -70, 190, 35, 40, 120})));
  EXPECT_GT(bent.smallest_singular_value, 0.01);
  EXPECT_NEAR(bent.condition * bent.smallest_singular_value, 2, 1);  // the largest is 1 to 3
}

TEST(Dexterity, IsTheDeterminantOfASquareJacobian) {
  const SixJoints joints = radians({20, -70, 190, 35, 40, 120});
  const auto arm = parol6_commander();
  const auto solver = SphericalWrist::of(arm);
  const auto clearance = solver->clearance(joints);
  // With a spherical wrist det J is a product: the wrist's distance from axis 1, both links, the
  // sines of elbow and wrist.
  const double forearm = std::hypot(0.0435, 0.17635);
  const double expected = clearance.shoulder * 0.18 * forearm * clearance.elbow * clearance.wrist;
  EXPECT_NEAR(dexterity(jacobian(arm, joints)).manipulability, expected, 1e-12);
}

TEST(Jacobian, OfASlidingJointIsItsAxis) {
  Arm arm{.name = "lift"};
  arm.joints.push_back({.name = "z", .kind = Joint::Kind::kPrismatic});
  arm.tool = translation({0.3, 0, 0});
  const std::array joints{0.25};
  EXPECT_EQ(forward(arm, joints).position, (Vector3{0.3, 0, 0.25}));
  const auto columns = jacobian(arm, joints);
  EXPECT_EQ(columns[0].linear, (Vector3{0, 0, 1}));
  EXPECT_EQ(columns[0].angular, Vector3{});
}

}  // namespace
}  // namespace armjig::arm
