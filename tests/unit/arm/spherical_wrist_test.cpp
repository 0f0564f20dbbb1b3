// SPDX-License-Identifier: Apache-2.0
#include "harness/arm/spherical_wrist.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <kdl/chainiksolverpos_lma.hpp>
#include <numbers>
#include <random>

#include "harness/arm/models.hpp"
#include "tests/unit/arm/degrees.hpp"
#include "tests/unit/arm/kdl_arm.hpp"

namespace armjig::arm {
namespace {

using test::difference;
using test::kdl_pose;
using test::ours;
using test::rad;
using test::radians;

constexpr double kAgree = 1e-9;
constexpr double kTurn = 2 * std::numbers::pi;

/// Postures within an arm's limits; endless joints get one turn.
class Postures {
 public:
  Postures(Arm arm, std::uint64_t seed) : arm_{std::move(arm)}, engine_{seed} {}

  SixJoints next() {
    SixJoints joints{};
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const double lower = std::max(arm_.joints[j].lower, -kTurn / 2);
      const double upper = std::min(arm_.joints[j].upper, lower + kTurn);
      const double share = static_cast<double>(engine_() >> 11U) * 0x1p-53;
      joints[j] = lower + (upper - lower) * share;
    }
    return joints;
  }

 private:
  Arm arm_;
  std::mt19937_64 engine_;
};

/// The farthest that a joint is from another posture, whole turns apart.
double apart(const SixJoints& a, const SixJoints& b) {
  double most = 0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    most = std::max(most, std::abs(std::remainder(a[j] - b[j], kTurn)));
  }
  return most;
}

double nearest_branch(const Branches& branches, const SixJoints& joints) {
  double best = kTurn;
  for (const auto& branch : branches) best = std::min(best, apart(branch.joints, joints));
  return best;
}

struct Subject {
  std::string_view name;
  Arm arm;
  KDL::Chain chain;
};
void PrintTo(const Subject& subject, std::ostream* out) { *out << subject.name; }

class SphericalWrists : public testing::TestWithParam<Subject> {};
INSTANTIATE_TEST_SUITE_P(Arms, SphericalWrists,
                         testing::Values(Subject{"parol6", parol6_commander(), test::kdl_parol6()},
                                         Subject{"jaco", jaco(JacoVariant::kJaco2Spherical),
                                                 test::kdl_spherical_jaco()}));

TEST_P(SphericalWrists, ForwardKinematicsAgreeWithKdl) {
  const auto& [name, arm, chain] = GetParam();
  Postures postures{arm, 1};
  for (int i = 0; i < 2'000; ++i) {
    const auto joints = postures.next();
    ASSERT_LT(difference(forward(arm, joints), ours(kdl_pose(chain, joints))), kAgree);
  }
}

TEST_P(SphericalWrists, EveryBranchReachesThePoseAsKdlSeesIt) {
  const auto& [name, arm, chain] = GetParam();
  const auto solver = SphericalWrist::of(arm);
  ASSERT_TRUE(solver);
  Postures postures{arm, 2};
  for (int i = 0; i < 2'000; ++i) {
    const auto pose = ours(kdl_pose(chain, postures.next()));
    const auto branches = solver->solve(pose);
    ASSERT_GE(branches.size(), 2U);
    for (const auto& branch : branches) {
      ASSERT_LT(difference(ours(kdl_pose(chain, branch.joints)), pose), kAgree);
    }
  }
}

TEST_P(SphericalWrists, NoReachablePoseIsMissed) {
  const auto& [name, arm, chain] = GetParam();
  const auto solver = SphericalWrist::of(arm);
  ASSERT_TRUE(solver);
  Postures postures{arm, 3};
  for (int i = 0; i < 20'000; ++i) {
    const auto joints = postures.next();
    const auto branches = solver->solve(forward(arm, joints));
    ASSERT_LT(nearest_branch(branches, joints), 1e-6) << "posture " << i;
    ASSERT_TRUE(nearest(arm, branches, joints)) << "posture " << i;
  }
}

TEST_P(SphericalWrists, WhatKdlFindsIsOneOfTheBranches) {
  const auto& [name, arm, chain] = GetParam();
  const auto solver = SphericalWrist::of(arm);
  KDL::ChainIkSolverPos_LMA lma{chain, 1e-10, 500, 1e-14};
  Postures postures{arm, 4};
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    const auto frame = kdl_pose(chain, postures.next());
    KDL::JntArray answer{6};
    if (lma.CartToJnt(test::kdl_joints(postures.next()), frame, answer) != 0) continue;
    ++found;
    SixJoints joints;
    for (unsigned j = 0; j < 6; ++j) joints[j] = answer(j);
    const auto reached = ours(kdl_pose(chain, joints));  // it stops at a small distance
    EXPECT_LT(nearest_branch(solver->solve(reached), joints), 1e-6) << "posture " << i;
  }
  EXPECT_GT(found, 100);
}

TEST(SphericalWrist, IsNotThatOfACurvedWrist) {
  EXPECT_FALSE(SphericalWrist::of(jaco(JacoVariant::kJaco2Curved)));
}

TEST(SphericalWrist, HasEightBranchesInTheOpen) {
  const auto arm = parol6_commander();
  const auto branches =
      SphericalWrist::of(arm)->solve(forward(arm, radians({10, -60, 200, 20, -30, 100})));
  EXPECT_EQ(branches.size(), 8U);
}

TEST(SphericalWrist, HasNoBranchOutOfReach) {
  const auto solver = SphericalWrist::of(parol6_commander());
  EXPECT_TRUE(solver->solve(translation({0.6, 0, 0.2})).empty());
}

TEST(SphericalWrist, TakesJointFourFromTheSeedWhereTheWristIsStraight) {
  const auto arm = parol6_commander();
  const auto joints = radians({20, -70, 190, 35, 0, 120});
  const auto branches = SphericalWrist::of(arm)->solve(forward(arm, joints), joints);
  EXPECT_LT(nearest_branch(branches, joints), 1e-7);
}

TEST(SphericalWrist, TakesJointOneFromTheSeedWhereTheWristIsAboveTheBase) {
  // Of this arm, axis 1 meets the upper arm; bent back it has its wrist above its base.
  const std::array rows{DhRow{0.3, 0, -std::numbers::pi / 2}, DhRow{0, 0.3, 0},
                        DhRow{0, 0, -std::numbers::pi / 2},   DhRow{0.3, 0, std::numbers::pi / 2},
                        DhRow{0, 0, -std::numbers::pi / 2},   DhRow{0.1, 0, 0}};
  const auto arm = arm_from_dh("elbow", rows);
  const auto joints = radians({33, -60, -150, 10, 40, 20});
  const auto pose = forward(arm, joints);
  const auto wrist = pose.position - 0.1 * pose.rotation.z_axis();
  ASSERT_LT(std::hypot(wrist.x, wrist.y), 1e-12);
  const auto branches = SphericalWrist::of(arm)->solve(pose, joints);
  EXPECT_LT(nearest_branch(branches, joints), 1e-7);
}

TEST(SphericalWrist, ReachesItsEdge) {
  const auto arm = parol6_commander();
  // The forearm in line with the upper arm: joint 3 is where the 43.5 mm at the elbow put it.
  const double straight = std::numbers::pi / 2 - std::atan2(0.0435, 0.17635);
  for (const double q3 : {straight, straight + std::numbers::pi}) {
    SixJoints joints = radians({15, -80, 0, 30, 50, 100});
    joints[2] = q3;
    const auto pose = forward(arm, joints);
    const auto branches = SphericalWrist::of(arm)->solve(pose);
    ASSERT_FALSE(branches.empty());
    for (const auto& branch : branches) {
      EXPECT_LT(difference(forward(arm, branch.joints), pose), kAgree);
    }
  }
}

TEST(WithinLimits, TurnsJointsToTheSeedsSide) {
  const auto arm = parol6_commander();
  const auto joints = radians({10, -60, -160, 20, -30, -100});
  const auto near_standby = within_limits(arm, joints, radians({0, -90, 180, 0, 0, 180}));
  ASSERT_TRUE(near_standby);
  EXPECT_NEAR((*near_standby)[2], rad(200), 1e-12);
  EXPECT_NEAR((*near_standby)[5], rad(260), 1e-12);
}

TEST(WithinLimits, HasTwoPlacesForAJointOfAWholeTurn) {
  const auto arm = parol6_commander();
  const auto joints = radians({0, -90, 180, 0, 0, 0});
  EXPECT_EQ((*within_limits(arm, joints, radians({0, -90, 180, 0, 0, 10})))[5], 0);
  EXPECT_NEAR((*within_limits(arm, joints, radians({0, -90, 180, 0, 0, 350})))[5], kTurn, 1e-12);
}

TEST(WithinLimits, RefusesWhatNoTurnPutsThere) {
  const auto joints = radians({130, -90, 180, 0, 0, 180});
  EXPECT_FALSE(within_limits(parol6_commander(), joints, joints));
}

TEST(Nearest, PrefersTheBranchOfTheSeed) {
  const auto arm = parol6_commander();
  const auto solver = SphericalWrist::of(arm);
  const auto joints = radians({10, -60, 200, 90, -30, 100});
  const auto branches = solver->solve(forward(arm, joints));
  EXPECT_LT(apart(*nearest(arm, branches, joints), joints), 1e-9);
  const auto flipped = radians({10, -60, 200, -90, 30, 280});
  EXPECT_LT(apart(*nearest(arm, branches, flipped), flipped), 1e-9);
}

}  // namespace
}  // namespace armjig::arm
