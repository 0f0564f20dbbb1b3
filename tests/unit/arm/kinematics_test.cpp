// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <ostream>

#include "harness/arm/arm.hpp"
#include "harness/arm/models.hpp"
#include "harness/arm/orientation.hpp"
#include "harness/arm/spherical_wrist.hpp"
#include "tests/unit/arm/degrees.hpp"

// Postures, poses and angles are those of the references of both devices, degrees and mm or m
// there.
namespace armjig::arm {
namespace {

using test::rad;
using test::radians;

constexpr double deg(double radians) { return radians * (180 / std::numbers::pi); }

/// A posture of PAROL6, the tool's place and the commander's angles there, the flange's place.
struct Parol6Posture {
  SixJoints degrees{};
  Vector3 tool_mm{};
  Angles angles_deg{};
  Vector3 flange_mm{};

  friend std::ostream& operator<<(std::ostream& out, const Parol6Posture& posture) {
    for (const double q : posture.degrees) out << q << ' ';
    return out;
  }
};

const std::array kParol6Postures{
    Parol6Posture{{0, 0, 0, 0, 0, 0}, {114.67, 0, 349.65}, {0, 0, 0}, {159.920721, 0, 323.85}},
    Parol6Posture{
        {0, -90, 180, 0, 0, 180}, {262.57, 0, 288.75}, {0, 90, 180}, {236.770721, 0, 334}},
    Parol6Posture{
        {90, -90, 180, 0, 0, 180}, {0, 262.57, 288.75}, {-90, 0, -90}, {0, 236.770721, 334}},
    Parol6Posture{{85.192, -104.451, 158.769, -1.983, -46.491, 179.899},
                  {10.69063, 159.714331, 229.836424},
                  {-84.681262, 1.439501, -143.25391},
                  {14.235739, 180.323985, 277.542891}},
    Parol6Posture{{10, -60, 200, 20, -30, 100},
                  {325.356032, 86.621728, 219.473828},
                  {58.839495, 52.116288, 176.78105},
                  {319.371512, 49.888832, 255.916449}},
};

void expect_near(const Vector3& actual, const Vector3& expected, double tolerance) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

class Parol6Postures : public testing::TestWithParam<Parol6Posture> {};
INSTANTIATE_TEST_SUITE_P(Reference, Parol6Postures, testing::ValuesIn(kParol6Postures));

TEST_P(Parol6Postures, PutTheCommandersToolWhereTheReferenceHasIt) {
  const auto pose = forward(parol6_commander(), radians(GetParam().degrees));
  expect_near(1000 * pose.position, GetParam().tool_mm, 1e-6);
}

TEST_P(Parol6Postures, ShowTheCommandersAngles) {
  const auto pose = forward(parol6_commander(), radians(GetParam().degrees));
  const auto angles = angles_of(pose.rotation, Convention::kCommander);
  const auto [rx, ry, rz] = GetParam().angles_deg;
  EXPECT_NEAR(deg(angles.rx), rx, 1e-6);
  EXPECT_NEAR(deg(angles.ry), ry, 1e-6);
  EXPECT_NEAR(std::abs(deg(angles.rz)), std::abs(rz), 1e-6);  // -180 is 180
}

TEST_P(Parol6Postures, PutTheFlangeWhereTheReferenceHasIt) {
  const auto pose = forward(parol6_flange(), radians(GetParam().degrees));
  expect_near(1000 * pose.position, GetParam().flange_mm, 1e-6);
}

TEST_P(Parol6Postures, HaveOneTransformBetweenFlangeAndCommandersTool) {
  const auto joints = radians(GetParam().degrees);
  const auto tool =
      with_tool(parol6_flange(), {rotation_x(std::numbers::pi), {-0.04525, 0, -0.0258}});
  const auto expected = forward(parol6_commander(), joints);
  const auto actual = forward(tool, joints);
  constexpr double kLengthsDiffer = 1e-6;  // the two tables have a link of 0.7 um more or less
  expect_near(actual.position, expected.position, kLengthsDiffer);
  EXPECT_LT(angle_between(actual.rotation, expected.rotation), 1e-12);
}

TEST(Orientation, OfTheCommanderTurnsAboutZWithItsFirstAngle) {
  const auto about_z = rotation_of({rad(30), 0, 0}, Convention::kCommander);
  EXPECT_LT(angle_between(about_z, rotation_z(rad(30))), 1e-15);
  const auto about_x = rotation_of({0, 0, rad(30)}, Convention::kCommander);
  EXPECT_LT(angle_between(about_x, rotation_x(rad(30))), 1e-15);
}

TEST(Orientation, OfTheApiTurnsAboutXWithItsFirstAngle) {
  const auto about_x = rotation_of({rad(30), 0, 0}, Convention::kXyz);
  EXPECT_LT(angle_between(about_x, rotation_x(rad(30))), 1e-15);
}

TEST(Orientation, OfEveryConventionTurnsAboutYWithItsSecondAngle) {
  for (const auto& [convention, name, formula] : conventions()) {
    const auto about_y = rotation_of({0, rad(30), 0}, convention);
    EXPECT_LT(angle_between(about_y, rotation_y(rad(30))), 1e-15) << name;
  }
}

TEST(Orientation, OfUrdfAppliesRollFirst) {
  const auto rotation = rotation_of({rad(90), 0, rad(90)}, Convention::kRollPitchYaw);
  expect_near(rotation * Vector3{0, 1, 0}, {0, 0, 1}, 1e-15);  // roll, then yaw about the base's z
  expect_near(rotation * Vector3{1, 0, 0}, {0, 1, 0}, 1e-15);
}

TEST(Orientation, AnglesOfARotationGiveItBack) {
  for (const auto& [convention, name, formula] : conventions()) {
    for (const double rx : {-170.0, -31.0, 0.0, 179.0}) {
      for (const double ry : {-90.0, -89.999, -20.0, 0.0, 45.0, 90.0}) {
        for (const double rz : {-100.0, 0.0, 12.0, 180.0}) {
          const auto rotation = rotation_of({rad(rx), rad(ry), rad(rz)}, convention);
          const auto again = rotation_of(angles_of(rotation, convention), convention);
          EXPECT_LT(angle_between(rotation, again), 1e-9)
              << name << ": " << rx << ' ' << ry << ' ' << rz;
        }
      }
    }
  }
}

/// Angles as the Jaco reports them, the hand's place, and its pitch, yaw and roll.
struct JacoPosture {
  JacoVariant variant{};
  SixJoints degrees{};
  Vector3 hand_m{};
  Angles angles{};
};

TEST(Jaco, PutsItsHandWhereTheReferenceHasIt) {
  constexpr auto kCurved = JacoVariant::kJaco2Curved;
  const SixJoints ready{275.2882, 167.5798, 57.4104, 240.8248, 82.8382, 75.8195};
  const std::array postures{
      JacoPosture{kCurved, ready, {0.212780, -0.256650, 0.506915}, {1.652673, 1.116417, 0.120561}},
      JacoPosture{kCurved,
                  {-89.7796, 150.0519, 26.8603, -92.1775, 5.1795, 99.7520},
                  {0.027821, -0.169285, 0.297998},
                  {2.148731, 0.075051, -0.175268}},
      JacoPosture{kCurved,
                  {275, 170, 60, 240, 80, 75},
                  {0.209132, -0.281896, 0.514642},
                  {1.613924, 1.074620, 0.196427}},
      JacoPosture{kCurved,
                  {180, 180, 180, 180, 180, 180},
                  {0, 0.259514, 0.876972},
                  {-2.094395, 0, -1.570796}},
      JacoPosture{kCurved, {270, 180, 180, 0, 0, 0}, {-0.064300, 0, 1.181145}, {0, 0, 0}},
      JacoPosture{JacoVariant::kJaco1Curved,
                  ready,
                  {0.220784, -0.260671, 0.506355},
                  {1.652673, 1.116417, 0.120561}},
      JacoPosture{JacoVariant::kJaco2Spherical,
                  {180, 180, 180, 180, 180, 180},
                  {0, 0.0098, 1.2604},
                  {0, 0, -1.570796}},
  };
  for (const auto& posture : postures) {
    SCOPED_TRACE(posture.degrees[0]);
    const auto pose = forward(jaco(posture.variant), radians(posture.degrees));
    const auto angles = angles_of(pose.rotation, Convention::kXyz);
    expect_near(pose.position, posture.hand_m, 1e-6);
    expect_near({angles.rx, angles.ry, angles.rz},
                {posture.angles.rx, posture.angles.ry, posture.angles.rz}, 1e-6);
  }
}

TEST(Arm, ReportsTheFirstJointBeyondItsLimits) {
  const auto arm = parol6_commander();
  EXPECT_EQ(first_outside(arm, radians({90, -90, 180, 0, 90, 360})), arm.joint_count());
  EXPECT_EQ(first_outside(arm, radians({90, -90, 180, 0, 90.001, 361})), 4U);
}

TEST(Arm, CarriesItsToolAlong) {
  const auto joints = radians({10, -60, 200, 20, -30, 100});
  const auto flange = forward(parol6_flange(), joints);
  const auto gripper = forward(with_tool(parol6_flange(), translation({0, 0, -0.105})), joints);
  expect_near(gripper.position, flange.position - 0.105 * flange.rotation.z_axis(), 1e-15);
}

}  // namespace
}  // namespace armjig::arm
