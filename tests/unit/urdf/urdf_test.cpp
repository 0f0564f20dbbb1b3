// SPDX-License-Identifier: Apache-2.0
#include "harness/urdf/urdf.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "harness/arm/models.hpp"
#include "harness/arm/spherical_wrist.hpp"

namespace armjig::arm {
namespace {

using testing::HasSubstr;

/// PAROL6 as its API has it, written as a robot description, with a fixed gripper at its end.
constexpr auto kParol6 = R"(<robot name="parol">
  <link name="base"/><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
  <link name="e"/><link name="f"/><link name="finger"/>
  <joint name="L1" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
    <origin xyz="0 0 0.1105"/><limit lower="-2.1" upper="2.1" velocity="3" effort="300"/></joint>
  <joint name="L2" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
    <origin xyz="0.0234207210610375 0 0" rpy="-1.5707963267949 0 0"/>
    <limit lower="-2.5" upper="-0.05" velocity="3" effort="300"/></joint>
  <joint name="L3" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 0 2"/>
    <origin xyz="0.18 0 0" rpy="3.14159265358979 0 0"/>
    <limit lower="1.88" upper="5.02" velocity="3" effort="300"/></joint>
  <joint name="L4" type="revolute"><parent link="c"/><child link="d"/><axis xyz="0 0 1"/>
    <origin xyz="-0.0435 0.17635 0" rpy="1.5707963267949 0 0"/>
    <limit lower="-1.84" upper="1.84" velocity="3" effort="300"/></joint>
  <joint name="L5" type="revolute"><parent link="d"/><child link="e"/><axis xyz="0 0 1"/>
    <origin rpy="-1.5707963267949 0 0"/><limit lower="-1.57" upper="1.57" velocity="3" effort="3"/>
  </joint>
  <joint name="L6" type="continuous"><parent link="e"/><child link="f"/><axis xyz="0 0 1"/>
    <origin xyz="0 0.037 0" rpy="1.5707963267949 0 0"/></joint>
  <joint name="mount" type="fixed"><parent link="f"/><child link="finger"/>
    <origin xyz="0 0 -0.105"/></joint>
</robot>)";

std::string with(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

std::string problem_with(const std::string& xml, std::string_view tip = {}) {
  const auto arm = arm_from_urdf("robot.urdf", xml, tip);
  EXPECT_FALSE(arm.has_value());
  return arm ? "" : describe(arm.error());
}

constexpr SixJoints kJoints{0.2, -1.1, 3.4, 0.3, -0.5, 1.7};

TEST(Urdf, IsTheSameArmAsItsTable) {
  const auto arm = arm_from_urdf("robot.urdf", kParol6);
  ASSERT_TRUE(arm.has_value()) << describe(arm.error());
  const auto expected = forward(with_tool(parol6_flange(), translation({0, 0, -0.105})), kJoints);
  const auto actual = forward(*arm, kJoints);
  EXPECT_LT(norm(actual.position - expected.position), 1e-9);
  EXPECT_LT(angle_between(actual.rotation, expected.rotation), 1e-9);
  EXPECT_EQ(arm->name, "parol");
  EXPECT_EQ(arm->joints[1].lower, -2.5);
  EXPECT_EQ(arm->joints[1].max_speed, 3);
  EXPECT_TRUE(arm->joints[5].is_continuous());
}

TEST(Urdf, IsSolvedInClosedFormIfItHasASphericalWrist) {
  const auto arm = arm_from_urdf("robot.urdf", kParol6);
  ASSERT_TRUE(arm.has_value());
  const auto solver = SphericalWrist::of(*arm);
  ASSERT_TRUE(solver);
  const auto pose = forward(*arm, kJoints);
  const auto joints = nearest(*arm, solver->solve(pose), kJoints);
  ASSERT_TRUE(joints);
  for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR((*joints)[j], kJoints[j], 1e-9);
}

TEST(Urdf, EndsAtTheLinkAskedFor) {
  const auto arm = arm_from_urdf("robot.urdf", kParol6, "c");
  ASSERT_TRUE(arm.has_value());
  EXPECT_EQ(arm->joint_count(), 3U);
}

TEST(Urdf, HasJointsThatSlide) {
  const auto arm = arm_from_urdf("robot.urdf", with(kParol6, "\"revolute\"", "\"prismatic\""));
  ASSERT_TRUE(arm.has_value());
  EXPECT_EQ(arm->joints[0].kind, Joint::Kind::kPrismatic);
}

TEST(Urdf, SaysWhatIsWrongInOneSentence) {
  EXPECT_THAT(problem_with(std::string("\0\1\2\xFF", 4)), HasSubstr("not a robot description"));
  EXPECT_THAT(problem_with("<robot name='x'/>"), HasSubstr("not a robot description"));
  EXPECT_THAT(problem_with(kParol6, "hand"), HasSubstr("ends in: finger"));
  EXPECT_THAT(problem_with(kParol6, "base"), HasSubstr("0 joints lead to it"));
  EXPECT_THAT(problem_with(with(kParol6, "xyz=\"0 0 2\"", "xyz=\"0 0 0\"")),
              HasSubstr("axis has no direction"));
  EXPECT_THAT(problem_with(with(kParol6, "\"continuous\"", "\"floating\"")),
              HasSubstr("turn or slide"));
  EXPECT_THAT(problem_with(with(kParol6, "lower=\"-2.5\"", "lower=\"2.5\"")),
              HasSubstr("lower limit is above"));
  EXPECT_THAT(problem_with(with(kParol6, "parent link=\"f\"", "parent link=\"e\"")),
              HasSubstr("one of: f, finger"));
}

TEST(Urdf, HasDepthAndSizeWithinReason) {
  std::string deep = "<robot name='r'>";
  for (int i = 0; i < 200'000; ++i) deep += "<a>";
  EXPECT_THAT(problem_with(deep, ""), HasSubstr("levels deep"));
  std::string wide = "<robot name='r'>";
  for (int i = 0; i < 100'000; ++i) wide += "<link name='>'/>";
  EXPECT_THAT(problem_with(wide + "</robot>", ""), HasSubstr("over 100000 elements"));
}

TEST(Urdf, ManyEndsAreNotAllNamed) {
  std::string star = "<robot name='r'><link name='base'/>";
  for (int i = 0; i < 30; ++i) {
    star += fmt::format(
        "<link name='l{0}'/><joint name='j{0}' type='fixed'><parent link='base'/>"
        "<child link='l{0}'/></joint>",
        i);
  }
  EXPECT_THAT(problem_with(star + "</robot>", ""), HasSubstr("and 20 more"));
}

TEST(Urdf, FilesThatAreNotThereCannotBeRead) {
  const auto arm = read_urdf("/nonexistent.urdf");
  ASSERT_FALSE(arm.has_value());
  EXPECT_EQ(arm.error().code, ErrorCode::kCannotRead);
}

}  // namespace
}  // namespace armjig::arm
