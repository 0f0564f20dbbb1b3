// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/readings.hpp"

#include <gtest/gtest.h>

namespace armjig::parol6 {
namespace {

using namespace std::chrono_literals;

TEST(Readings, ObjectsHaveTheirLowBitFirst) {
  // docs/spec/parol6.md, "Flag bytes": 20 is object 1, 10 is object 2, 30 is 3.
  EXPECT_EQ(object_of(0xC1), GripperObject::kNone);
  EXPECT_EQ(object_of(0xE1), GripperObject::kWhileClosing);
  EXPECT_EQ(object_of(0xD5), GripperObject::kWhileOpening);
  EXPECT_EQ(object_of(0xF1), GripperObject::kAtPosition);
  EXPECT_EQ(object_of(0x0C), GripperObject::kNone) << "errors are no objects";
}

TEST(Readings, TicksAreOneAndFourNinthsOfAMicrosecond) {
  // 90 MHz / 128 = 703,125 Hz: 7032 ticks are 10.0011 ms.
  EXPECT_EQ(interval_of(0), 0ns);
  EXPECT_EQ(interval_of(9), 12800ns);
  EXPECT_EQ(interval_of(7032), 10'001'066ns);
  EXPECT_EQ(interval_of(65535), 93'205'333ns);
}

TEST(Readings, FlagsBeginInTheHighestBit) {
  TelemetryFrame frame{.homed = 0x83, .io = 0x0F};
  EXPECT_TRUE(is_homed(frame, 0));
  EXPECT_FALSE(is_homed(frame, 5));
  EXPECT_FALSE(is_homed(frame));
  frame.homed = 0xFF;
  EXPECT_TRUE(is_homed(frame));
  EXPECT_FALSE(is_estop_pressed(frame)) << "the bit says released";
  frame.io = 0x07;
  EXPECT_TRUE(is_estop_pressed(frame));
}

}  // namespace
}  // namespace armjig::parol6
