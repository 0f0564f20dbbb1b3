// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <numbers>

#include "harness/arm/pose.hpp"
#include "harness/arm/spherical_wrist.hpp"

/// The same arms as models.cpp, entered a second time for Orocos KDL, which judges ours.
namespace armjig::test {

inline KDL::Segment kdl_row(double d, double a, double alpha, double sign = 1, double offset = 0) {
  return KDL::Segment{KDL::Joint{KDL::Joint::RotZ, sign}, KDL::Frame::DH(a, alpha, d, offset)};
}

inline KDL::Chain kdl_parol6() {
  constexpr double kRight = std::numbers::pi / 2;
  KDL::Chain chain;
  chain.addSegment(kdl_row(0.1105, 0.02342, -kRight));
  chain.addSegment(kdl_row(0, 0.180, 2 * kRight));
  chain.addSegment(kdl_row(0, -0.0435, kRight));
  chain.addSegment(kdl_row(-0.17635, 0, -kRight));
  chain.addSegment(kdl_row(0, 0, kRight));
  chain.addSegment(kdl_row(-0.0628, -0.04525, 2 * kRight));
  return chain;
}

inline KDL::Chain kdl_spherical_jaco() {
  constexpr double kRight = std::numbers::pi / 2;
  KDL::Chain chain;
  chain.addSegment(
      KDL::Segment{KDL::Joint{KDL::Joint::None}, KDL::Frame{KDL::Rotation::RotX(2 * kRight)}});
  chain.addSegment(kdl_row(-0.2755, 0, kRight, 1, -2 * kRight));
  chain.addSegment(kdl_row(0, 0.41, 2 * kRight, 1, kRight));
  chain.addSegment(kdl_row(-0.0098, 0, kRight, 1, kRight));
  chain.addSegment(kdl_row(-(0.2073 + 0.1038), 0, kRight));
  chain.addSegment(kdl_row(0, 0, kRight));
  chain.addSegment(kdl_row(-(0.1038 + 0.16), 0, 2 * kRight, 1, -kRight));
  return chain;
}

inline KDL::JntArray kdl_joints(const arm::SixJoints& joints) {
  KDL::JntArray array{6};
  for (unsigned j = 0; j < 6; ++j) array(j) = joints[j];
  return array;
}

inline KDL::Frame kdl_pose(const KDL::Chain& chain, const arm::SixJoints& joints) {
  KDL::Frame frame;
  KDL::ChainFkSolverPos_recursive{chain}.JntToCart(kdl_joints(joints), frame);
  return frame;
}

inline arm::Pose ours(const KDL::Frame& frame) {
  arm::Pose pose;
  const auto& m = frame.M;
  pose.rotation.rows = {arm::Vector3{m(0, 0), m(0, 1), m(0, 2)},
                        arm::Vector3{m(1, 0), m(1, 1), m(1, 2)},
                        arm::Vector3{m(2, 0), m(2, 1), m(2, 2)}};
  pose.position = {frame.p.x(), frame.p.y(), frame.p.z()};
  return pose;
}

/// The largest difference between two poses, in metres or in elements of the matrix.
inline double difference(const arm::Pose& a, const arm::Pose& b) {
  const auto largest = [](const arm::Vector3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  };
  double most = largest(a.position - b.position);
  for (std::size_t i = 0; i < 3; ++i) {
    most = std::max(most, largest(a.rotation.rows[i] - b.rotation.rows[i]));
  }
  return most;
}

}  // namespace armjig::test
