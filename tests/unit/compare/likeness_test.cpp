// SPDX-License-Identifier: Apache-2.0
#include "harness/compare/likeness.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <vector>

#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

RecordedMessage telemetry(std::int32_t position, std::uint8_t homed) {
  parol6::TelemetryFrame frame{.homed = homed};
  frame.position[0] = Steps{position};
  std::vector<Message> found;
  parol6::make_dissector()->feed(Direction::kFromDevice, at(1s), parol6::encode(frame), found);
  return {.message = found.at(0), .note = {}};
}

class LikenessBetweenTwo : public testing::Test {
 protected:
  [[nodiscard]] bool is_come_past(const RecordedMessage& one) const {
    return Likeness{rules}.is_come_past_by(one, std::vector{before}, std::vector{after});
  }

  ComparisonRules rules;
  RecordedMessage before = telemetry(100, 0x03);
  RecordedMessage after = telemetry(200, 0x43);
};

TEST_F(LikenessBetweenTwo, ANumberLiesBetweenThem) {
  for (const auto position : {100, 101, 150, 200})
    EXPECT_TRUE(is_come_past(telemetry(position, 0x03)));
  for (const auto position : {-150, 99, 201}) EXPECT_FALSE(is_come_past(telemetry(position, 0x03)));
}

TEST_F(LikenessBetweenTwo, AStateIsThatOfOneOfThem) {
  EXPECT_TRUE(is_come_past(telemetry(150, 0x43)));
  EXPECT_FALSE(is_come_past(telemetry(150, 0x23)))
      << "between 0x03 and 0x43, and what neither says";
}

TEST_F(LikenessBetweenTwo, AToleranceHoldsForEachOfThem) {
  rules.fields.push_back({.message = {}, .name = "position.j1", .tolerance = 5});
  EXPECT_TRUE(is_come_past(telemetry(205, 0x03)));
  EXPECT_FALSE(is_come_past(telemetry(206, 0x03)));
}

TEST_F(LikenessBetweenTwo, WhatIsTooEarlyOrTooLateDoesNotCount) {
  rules.time_tolerance = 10ms;
  before.message.time -= 10ms;
  EXPECT_TRUE(is_come_past(telemetry(150, 0x03)));
  before.message.time -= 1ms;
  EXPECT_FALSE(is_come_past(telemetry(150, 0x03)));
}

TEST_F(LikenessBetweenTwo, NothingIsAmongOthersOfAnotherNameOrNone) {
  EXPECT_FALSE(Likeness{rules}.is_come_past_by(before, std::vector<RecordedMessage>{}));
  after.message.name = "other";
  EXPECT_FALSE(is_come_past(telemetry(150, 0x03)));
}

}  // namespace
}  // namespace armjig
