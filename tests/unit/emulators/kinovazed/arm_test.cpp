// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "emulators/kinovazed/arm_port.hpp"
#include "emulators/kinovazed/jaco_kinematics.hpp"
#include "emulators/kinovazed/objectives.hpp"
#include "emulators/kinovazed/pose.hpp"

namespace armjig::kinovazed::emulation {
namespace {

using namespace std::chrono_literals;

void expect_near(const Pose& actual, const Pose& expected, float tolerance) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
  EXPECT_NEAR(actual.pitch, expected.pitch, tolerance);
  EXPECT_NEAR(actual.yaw, expected.yaw, tolerance);
  EXPECT_NEAR(actual.roll, expected.roll, tolerance);
}

/// The last way-point of Handle, where OpenDoor and PullDoor begin.
const Pose kHandle2{0.081576F, -0.689123F, 0.628466F, 1.482077F, -0.134015F, 0.007415F};

Pose point(Objective objective, std::size_t index, const Pose& here) {
  const auto set = published_objectives();
  const auto* const path = set.find(objective);
  return transformed(frame_of(path->origin.value_or(here)), path->points.at(index));
}

TEST(KinovaObjectives, LeadWhereTheOriginalComputes) {
  expect_near(point(Objective::kHandle, 0, {}),
              {0.100440F, -0.540117F, 0.621585F, 1.463947F, -0.094030F, 0.020215F}, 2e-6F);
  expect_near(point(Objective::kHandle, 1, {}), kHandle2, 2e-6F);
  expect_near(point(Objective::kAntenna, 1, {}),
              {-0.224850F, 0.235005F, 0.845014F, -0.995730F, -1.318464F, 0.176478F}, 2e-6F);
  expect_near(point(Objective::kPullDoor, 2, kHandle2),
              {-0.438910F, -0.245446F, 0.553590F, -2.814398F, -1.429396F, 1.901671F}, 2e-6F);
}

TEST(KinovaObjectives, CanBeSeenFromTheirFrame) {
  const auto origin = *published_objectives().find(Objective::kHandle)->origin;
  expect_near(transformed(inverse(frame_of(origin)), {0.2F, -0.3F, 0.5F, 1.6F, 0.1F, 0.2F}),
              {0.051714F, -0.017223F, -0.430069F, 0.110296F, 0.165385F, 0.190710F}, 2e-6F);
}

TEST(KinovaWorkspace, HasTheEdgesOfMixedPrecision) {
  EXPECT_TRUE(is_in_workspace({.x = -0.8F}));
  EXPECT_FALSE(is_in_workspace({.x = 0.8F}));
  EXPECT_FALSE(is_in_workspace({.y = 0.85F}));
  EXPECT_FALSE(is_in_workspace({.y = -0.85F}));
  EXPECT_FALSE(is_in_workspace({.z = 1.1501F}));
  EXPECT_TRUE(is_in_workspace({.z = -5}));
}

constexpr auto kFile = R"([{"name": "Home", "is_abs": true,
  "origin": {"X": 0, "Y": 0, "Z": 0, "pitch": 0, "yaw": 0, "roll": 0},
  "sequence": [{"X": 0.1, "Y": -0.2, "Z": 0.3, "pitch": 1, "yaw": 0.5, "roll": 0}]}])";

TEST(KinovaObjectives, AreReadFromTheServersFile) {
  const auto set = parse_objectives(kFile, "my.json");
  ASSERT_TRUE(set) << describe(set.error());
  ASSERT_NE(set->find(Objective::kHome), nullptr);
  EXPECT_EQ(set->find(Objective::kHome)->points.front(), (Pose{0.1F, -0.2F, 0.3F, 1, 0.5F, 0}));
  EXPECT_EQ(set->find(Objective::kHandle), nullptr);
}

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  return text.replace(text.find(what), what.size(), with);
}

TEST(KinovaObjectives, SayWhatIsWrongWithAFile) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"[", "my.json: the data is malformed; it is not JSON"},
      {"{}", "it is not a JSON array of objectives"},
      {"[3]", "[0] is not an object"},
      {replaced(kFile, "Home", "Bell"), "[0].name is not the name of an objective"},
      {replaced(kFile, "true", "1"), "[0].is_abs is neither true nor false"},
      {replaced(kFile, "\"Y\": -0.2,", ""), "[0].sequence[0].Y is missing or not a number"},
      {replaced(kFile, "0.3", "1e99"), "[0].sequence[0].Z is too large"},
      {R"([{"name":"Home","is_abs":false,"origin":{"X":0,"Y":0,"Z":0,"pitch":0,"yaw":0,"roll":0},
          "sequence":[]}])",
       "[0].sequence is not an array of at least one pose"},
  };
  for (const auto& [text, hint] : wrong) {
    const auto set = parse_objectives(text, "my.json");
    ASSERT_FALSE(set) << text;
    const auto said = describe(set.error());
    EXPECT_TRUE(said.starts_with("my.json: ")) << said;
    EXPECT_TRUE(said.ends_with(
        hint.substr(hint.rfind("; ") == std::string::npos ? 0 : hint.rfind("; ") + 2)))
        << said;
  }
}

TEST(JacoKinematics, AgreeWithKinovasPoses) {  // tables of the reference
  expect_near(forward(kReadyAngles),
              {0.212780F, -0.256650F, 0.506915F, 1.652673F, 1.116417F, 0.120561F}, 2e-6F);
  expect_near(forward({275, 170, 60, 240, 80, 75}),
              {0.209132F, -0.281896F, 0.514642F, 1.613924F, 1.074620F, 0.196427F}, 2e-6F);
  expect_near(forward({-89.7796, 150.0519, 26.8603, -92.1775, 5.1795, 99.7520}),
              {0.027821F, -0.169285F, 0.297998F, 2.148731F, 0.075051F, -0.175268F}, 2e-6F);
}

TEST(JacoKinematics, FindAnglesForEveryAbsoluteObjective) {
  for (const auto objective : {Objective::kHome, Objective::kHandle, Objective::kSuckDoor,
                               Objective::kAntenna, Objective::kPlaceBottle}) {
    const auto pose = point(objective, 0, {});
    const auto angles = solve(pose, kReadyAngles);
    ASSERT_TRUE(angles) << to_string(objective);
    expect_near(forward(*angles), pose, 5e-5F);
  }
  EXPECT_FALSE(solve({.x = 0.7F, .y = 0.7F, .z = 1.0F}, kReadyAngles));
}

template <class Arm>
Arm ready_arm(Instant& time) {
  Arm arm;
  arm.take_control();
  arm.press_home();
  time += 6s;
  arm.advance_to(time - 500ms);
  arm.advance_to(time);
  return arm;
}

TEST(JacoArm, TakesTheTimesOfARealOne) {
  Instant time{};
  auto arm = ready_arm<JacoArm>(time);
  ASSERT_EQ(arm.mode(), ArmMode::kReady);
  arm.press_home();
  arm.advance_to(time + 160ms);
  EXPECT_EQ(arm.mode(), ArmMode::kReady);
  arm.advance_to(time + 3260ms);
  EXPECT_EQ(arm.mode(), ArmMode::kReadyToFolded);
  arm.advance_to(time + 3280ms);
  EXPECT_EQ(arm.mode(), ArmMode::kFolded);
}

TEST(JacoArm, MovesToTheRightForwardAndUp) {  // as the document of the joystick has it
  Instant time{};
  auto arm = ready_arm<JacoArm>(time);
  const auto before = arm.pose();
  arm.move_stick({.translation = {-1, -1, 1}});
  arm.advance_to(time + 500ms);
  expect_near(
      arm.pose(),
      {before.x - 0.1F, before.y - 0.1F, before.z + 0.1F, before.pitch, before.yaw, before.roll},
      1e-5F);
  EXPECT_EQ(arm.mode(), ArmMode::kElsewhere);
}

TEST(JacoArm, TurnsJointsUnderAngularControl) {
  Instant time{};
  auto arm = ready_arm<JacoArm>(time);
  arm.select(Control::kAngular);
  const auto before = arm.joints();
  arm.move_stick({.wrist = {0, 0, 0.5F}});
  arm.advance_to(time + 1s);
  EXPECT_NEAR(arm.joints()[5], before[5] + 24, 1e-6);
  expect_near(arm.pose(), forward(arm.joints()), 1e-6F);
}

TEST(JacoArm, DoesNotTryWhatItCannotReach) {
  Instant time{};
  auto arm = ready_arm<JacoArm>(time);
  const auto before = arm.pose();
  arm.go_to({.x = 0.7F, .y = 0.7F, .z = 1.0F});
  arm.advance_to(time + 5s);
  EXPECT_EQ(arm.pose(), before);
}

TEST(JacoArm, CanBeMovedByHandWithoutControl) {
  Instant time{};
  auto arm = ready_arm<JacoArm>(time);
  arm.release_control();
  const auto before = arm.pose();
  arm.move_stick({.translation = {1, 0, 0}});
  arm.advance_to(time + 1s);
  EXPECT_EQ(arm.pose(), before);
  arm.move_by_hand({.translation = {1, 0, 0}});
  arm.advance_to(time + 2s);
  EXPECT_NEAR(arm.pose().x, before.x + 0.2F, 1e-5F);
}

TEST(BenchArm, TurnsRoundHalfWay) {  // captures/kinovazed/session-estop-mid-retract
  BenchArm arm{{.start_mode = ArmMode::kReady}};
  arm.take_control();
  arm.press_home();
  arm.advance_to(at(820ms));
  arm.release_all();
  arm.advance_to(at(1s));
  EXPECT_EQ(arm.mode(), ArmMode::kReadyToFolded);
  arm.press_home();
  arm.advance_to(at(1s + 815ms));
  EXPECT_EQ(arm.mode(), ArmMode::kFoldedToReady);
  arm.advance_to(at(1s + 825ms));
  EXPECT_EQ(arm.mode(), ArmMode::kReady);
}

TEST(ArmPort, FailsAfterSomeUsesForSome) {
  ArmPort port{BenchArm{}};
  port.fail(ArmCall::kErase, {.skip = 1, .count = 2});
  EXPECT_TRUE(port.attempt(ArmCall::kErase));
  EXPECT_FALSE(port.attempt(ArmCall::kErase));
  EXPECT_TRUE(port.attempt(ArmCall::kOpen));
  EXPECT_FALSE(port.attempt(ArmCall::kErase));
  EXPECT_TRUE(port.attempt(ArmCall::kErase));
  port.fail(ArmCall::kErase, {.count = -1});
  EXPECT_FALSE(port.attempt(ArmCall::kErase));
  EXPECT_FALSE(port.attempt(ArmCall::kErase));
  port.clear_failures();
  EXPECT_TRUE(port.attempt(ArmCall::kErase));
  port.unplug();
  EXPECT_FALSE(port.attempt(ArmCall::kErase));
}

}  // namespace
}  // namespace armjig::kinovazed::emulation
