// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/kinovazed_judge.hpp"

#include <gtest/gtest.h>

#include <string>

#include "harness/wire/kinovazed/vocabulary.hpp"

namespace armjig::kinovazed::rig {
namespace {

class Court {
 public:
  explicit Court(Permissions permissions = {}) : permissions_{permissions} {}

  bool allows(std::string_view text) {
    return !judge_->judge(std::as_bytes(std::span{text}), permissions_);
  }
  void hear(std::string_view text) { judge_->observe(std::as_bytes(std::span{text})); }
  [[nodiscard]] bool may_be_moving() const { return judge_->may_be_moving(); }
  [[nodiscard]] std::size_t opening() const { return judge_->opening_bytes().size(); }

 private:
  std::unique_ptr<Judge> judge_ = make_judge();
  Permissions permissions_;
};

Permissions only(Hazard hazard) {
  Permissions permissions;
  permissions.add(hazard);
  return permissions;
}

TEST(KinovaJudge, AllowsNothingButLookingAndStoppingAtFirst) {
  for (const auto verb : kVerbNames) {
    const bool is_harmless = verb == "EStop" || verb == "GetAbsolutePosition";
    EXPECT_EQ(Court{}.allows(std::string{verb} + "\r\n"), is_harmless) << verb;
  }
}

TEST(KinovaJudge, TellsStateFromMotionFromHoming) {
  EXPECT_TRUE(Court{only(Hazard::kState)}.allows("SetJoystickMode:XYZ\r\n"));
  EXPECT_FALSE(Court{only(Hazard::kState)}.allows("MoveJoystick:1:0:0\r\n"));
  EXPECT_TRUE(Court{only(Hazard::kMove)}.allows("MoveJoystick:1:0:0\r\n"));
  EXPECT_FALSE(Court{only(Hazard::kMove)}.allows("Initialize\r\n"));
  EXPECT_TRUE(Court{only(Hazard::kHome)}.allows("Initialize\r\n"));
}

TEST(KinovaJudge, SeesAWordHoweverItIsHidden) {
  EXPECT_FALSE(Court{}.allows("\nXRetract\r\n")) << "the shipped server swallows the X";
  EXPECT_FALSE(Court{}.allows("EStop\r\n" + std::string(128, ' ') + "\nXRetract")) << "at once";
  Court pieces;
  EXPECT_TRUE(pieces.allows("Re"));
  EXPECT_TRUE(pieces.allows("tra"));
  EXPECT_FALSE(pieces.allows("ct"));
  EXPECT_TRUE(pieces.allows("\r\nEStop\r\n")) << "what was refused was not written";
}

TEST(KinovaJudge, BeginsAConnectionByEndingAHalfSentLine) {
  Court court;
  EXPECT_EQ(court.opening(), 0U);
  EXPECT_TRUE(court.allows(std::string(128, 'A')));
  EXPECT_EQ(court.opening(), 2U) << "the shipped server keeps it for the next client";
  EXPECT_TRUE(court.allows("\r\n"));
  EXPECT_EQ(court.opening(), 0U);
}

TEST(KinovaJudge, BelievesInRestAfterTwoBeats) {
  Court court{Permissions::all()};
  EXPECT_FALSE(court.may_be_moving());
  EXPECT_TRUE(court.allows("Initialize\r\n"));
  EXPECT_TRUE(court.may_be_moving());
  court.hear("Heartbeat:21\r\n");
  EXPECT_TRUE(court.may_be_moving()) << "it may be older than the command";
  court.hear("Heartbeat:5\r\n");
  court.hear("Heartbeat:21\r\n");
  EXPECT_TRUE(court.may_be_moving());
  court.hear("Heartbeat:21\r\n");
  EXPECT_FALSE(court.may_be_moving());
}

TEST(KinovaJudge, TakesASteeredArmForStillOnlyWithTheStickAtRest) {
  Court court{Permissions::all()};
  EXPECT_TRUE(court.allows("MoveJoystick:1:0:0\r\n"));
  for (int i = 0; i < 3; ++i) court.hear("Heartbeat:69\r\n");
  EXPECT_TRUE(court.may_be_moving());
  EXPECT_TRUE(court.allows("MoveJoystick:0:0:0\r\n"));
  for (int i = 0; i < 2; ++i) court.hear("Heartbeat:69\r\n");
  EXPECT_FALSE(court.may_be_moving());
}

}  // namespace
}  // namespace armjig::kinovazed::rig
