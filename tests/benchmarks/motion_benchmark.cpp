// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cstdint>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <random>
#include <vector>

#include "harness/arm/models.hpp"
#include "harness/arm/spherical_wrist.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/planner.hpp"
#include "tests/unit/arm/kdl_arm.hpp"

namespace armjig {
namespace {

/// Reachable poses of PAROL6, the same for every benchmark: drawn within the joints' limits.
std::vector<arm::SixJoints> postures() {
  const auto arm = arm::parol6_commander();
  std::mt19937_64 engine{5};
  std::vector<arm::SixJoints> drawn(256);
  for (auto& joints : drawn) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const double share = static_cast<double>(engine() >> 11U) * 0x1p-53;
      joints[j] = arm.joints[j].lower + share * (arm.joints[j].upper - arm.joints[j].lower);
    }
  }
  return drawn;
}

arm::SixJoints standby_angles() {
  arm::SixJoints joints{};
  for (std::size_t j = 0; j < joints.size(); ++j) {
    joints[j] = parol6::planning::radians_of(j, parol6::kStandby[j]);
  }
  return joints;
}

void closed_form_all_branches(benchmark::State& state) {
  const auto arm = arm::parol6_commander();
  const auto solver = *arm::SphericalWrist::of(arm);
  std::vector<arm::Pose> poses;
  for (const auto& joints : postures()) poses.push_back(forward(arm, joints));
  std::size_t i = 0;
  for (auto _ : state) {
    auto branches = solver.solve(poses[i++ % poses.size()]);
    benchmark::DoNotOptimize(branches);
  }
}
BENCHMARK(closed_form_all_branches);

/// One solution of Orocos KDL's Levenberg-Marquardt from where homing ends, for those of the poses
/// that it finds at all.
void kdl_lma_one_solution(benchmark::State& state) {
  const auto chain = test::kdl_parol6();
  KDL::ChainIkSolverPos_LMA lma{chain};
  const auto seed = test::kdl_joints(standby_angles());
  KDL::JntArray answer{6};
  std::vector<KDL::Frame> frames;
  for (const auto& joints : postures()) {
    const auto frame = test::kdl_pose(chain, joints);
    if (lma.CartToJnt(seed, frame, answer) == 0) frames.push_back(frame);
  }
  std::size_t i = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(lma.CartToJnt(seed, frames[i++ % frames.size()], answer));
  state.counters["found"] = static_cast<double>(frames.size());
}
BENCHMARK(kdl_lma_one_solution);

/// Six joints, 4 s at 100 Hz, checks included.
void plan_joint_move(benchmark::State& state) {
  const parol6::planning::Move move{.kind = parol6::planning::Move::Kind::kJoint,
                                    .target = {0, -60, 200, 30, 45, 90},
                                    .timing = {.duration = 4}};
  const auto rules = state.range(0) == 0 ? parol6::planning::Rules::kDocumented
                                         : parol6::planning::Rules::kCommander;
  for (auto _ : state) {
    auto plan = parol6::planning::plan(move, parol6::kStandby, {.rules = rules});
    benchmark::DoNotOptimize(plan);
  }
}
BENCHMARK(plan_joint_move)->ArgName("commander")->Arg(0)->Arg(1);

void plan_line(benchmark::State& state) {
  const parol6::planning::Move move{.kind = parol6::planning::Move::Kind::kLine,
                                    .target = {0, 263.23, 161.241, -90, 0, -89.499},
                                    .timing = {.duration = 4}};
  for (auto _ : state) {
    auto plan = parol6::planning::plan(move, parol6::kStandby);
    benchmark::DoNotOptimize(plan);
  }
}
BENCHMARK(plan_line);

}  // namespace
}  // namespace armjig
