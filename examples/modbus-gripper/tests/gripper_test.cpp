// SPDX-License-Identifier: Apache-2.0
#include "gripper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "judge.hpp"

namespace gripper {
namespace {

using namespace armjig;
using namespace std::chrono_literals;

// 3.5 characters of silence, one for a character that may have begun, and a millisecond.
TEST(Unit, AnswersAfterItsSilence) {
  Unit unit{kUnit, 1200};
  unit.receive(at(100ms), read_request(kUnit, kModel, 1));
  unit.advance_to(at(142'249us));
  EXPECT_TRUE(unit.sent().empty());
  unit.advance_to(at(142'251us));
  ASSERT_EQ(unit.sent().size(), 1);
  EXPECT_EQ(unit.sent()[0].bytes, request(kUnit, {3, 2, 0x47, 0x52}));
}

TEST(Unit, IsACopyableSnapshot) {
  Unit unit{kUnit, 1200};
  unit.receive(at(100ms), read_request(kUnit, kModel, 1));
  auto copy = unit;
  copy.advance_to(at(1s));
  EXPECT_TRUE(unit.sent().empty());
  EXPECT_EQ(copy.sent().size(), 1);
}

TEST(Unit, TakesOnlyInputsThatItHas) {
  Unit unit{kUnit, 1200};
  EXPECT_TRUE(unit.set_input({}, "object", 250));
  EXPECT_FALSE(unit.set_input({}, "object", 1001));
  EXPECT_FALSE(unit.set_input({}, "jam", 2));
  EXPECT_FALSE(unit.set_input({}, "egg", 1));
}

class GripperJudge : public testing::Test {
 protected:
  bool is_allowed(Bytes bytes, Permissions permissions = {}) {
    return !judge_->judge(bytes, permissions);
  }
  static Permissions grip() {
    Permissions permissions;
    permissions.add(Hazard::kGrip);
    return permissions;
  }
  const std::unique_ptr<Judge> judge_ = make_judge();
};

TEST_F(GripperJudge, LetsReadAndStopWithoutPermission) {
  EXPECT_TRUE(is_allowed(read_request(kUnit, 0, 8)));
  EXPECT_TRUE(is_allowed(judge_->stop().front()));
}

TEST_F(GripperJudge, WantsPermissionForSettingsAndMoves) {
  EXPECT_FALSE(is_allowed(write_request(kUnit, kForce, 1)));
  EXPECT_FALSE(is_allowed(write_request(kUnit, kControl, 1)));
  EXPECT_FALSE(is_allowed(write_many_request(kBroadcast, kControl, {1, 2})));
  EXPECT_FALSE(judge_->may_be_moving());
  EXPECT_TRUE(is_allowed(write_request(kUnit, kControl, 1), grip()));
  EXPECT_TRUE(judge_->may_be_moving());
}

TEST_F(GripperJudge, FindsAMoveThatHidesInGarbage) {
  auto bytes = Frame(7, std::byte{1});
  const auto move = write_request(kUnit, kControl, 1);
  bytes.insert(bytes.end(), move.begin(), move.end() - 3);
  EXPECT_TRUE(is_allowed(bytes));
  EXPECT_FALSE(is_allowed(Bytes{move}.last(3)));
}

TEST_F(GripperJudge, BelievesTheGripperThatItStands) {
  ASSERT_TRUE(is_allowed(write_request(kUnit, kControl, 1), grip()));
  ASSERT_TRUE(is_allowed(read_request(kUnit, kStatus, 1)));
  judge_->observe(request(kUnit, {3, 2, 0, unsigned(Status::kMoving)}));
  EXPECT_TRUE(judge_->may_be_moving());
  judge_->observe(request(kUnit, {3, 2, 0, unsigned(Status::kArrived)}));
  EXPECT_FALSE(judge_->may_be_moving());
}

}  // namespace
}  // namespace gripper
