// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/wire/parol6/frame.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/options.hpp"

namespace armjig::parol6::emulation {
namespace {

/// Whether a board of these options answers an idle frame with that check byte.
bool answers(const DeviceOptions& options, std::uint8_t check) {
  auto arm = make(options, "emulated:");
  EXPECT_TRUE(arm.has_value());
  CommandFrame frame;
  frame.command = Command::kIdle;
  frame.check = check;
  arm->receive(Instant{}, encode(frame));
  arm->advance_to(at(std::chrono::milliseconds{1}));
  return !arm->sent().empty();
}

std::string hint_for(const DeviceOptions& options) {
  const auto arm = make(options, "emulated:");
  return arm ? "" : arm.error().where + ": " + arm.error().hint;
}

TEST(Parol6Options, MakeEitherProfile) {
  EXPECT_TRUE(answers({}, kCheckHost));
  EXPECT_TRUE(answers({{"profile", "firmware"}}, kCheckHost));
  EXPECT_FALSE(answers({{"profile", "documented"}}, kCheckHost));
  EXPECT_TRUE(answers({{"profile", "documented"}}, kCheckBoard));
}

TEST(Parol6Options, ChangeWhatTheProfileSays) {
  EXPECT_FALSE(answers({{"crc", "d4"}}, kCheckHost));
  EXPECT_TRUE(answers({{"crc", "ignore"}, {"profile", "documented"}}, kCheckHost));
  EXPECT_TRUE(answers({{"crc", "d4-or-e4"}, {"profile", "documented"}}, kCheckHost));
  EXPECT_FALSE(answers({{"crc", "d4-or-e4"}, {"profile", "documented"}}, 0));
}

TEST(Parol6Options, SayWhatThereIs) {
  EXPECT_EQ(hint_for({{"profile", "real"}}),
            "emulated:, profile=real: write firmware or documented");
  EXPECT_EQ(hint_for({{"crc", ""}}), "emulated:, crc=: write ignore, d4 or d4-or-e4");
  EXPECT_EQ(hint_for({{"estop", "1"}}), "emulated:, estop=1: write report or disable");
  EXPECT_EQ(hint_for({{"bounds", "x"}}), "emulated:, bounds=x: write none or stop");
  EXPECT_EQ(
      hint_for({{"color", "red"}}),
      "emulated:, color: parol6 has profile, crc, estop, bounds, pass-us, to-switch and fault");
}

TEST(Parol6Options, TakeTheirDocumentedValues) {
  expect_documented_values(options(),
                           [](const DeviceOptions& given, const std::string& where) {
                             return make(given, where).map([](const auto&) {});
                           },
                           {{"fault", {"zero:speed.j1,in.stuck:speed.j2", "zero:none"}}});
}

}  // namespace
}  // namespace armjig::parol6::emulation
