// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/brief.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string_view>
#include <vector>

namespace armjig {
namespace {

constexpr std::array kFew{
    Field{"start", 0, 1, Encoding::kLiteral, "", ""},
    Field{"speed", 1, 3, Encoding::kSigned, "steps/s", ""},
    Field{"state", 4, 1, Encoding::kUnsigned, "", ""},
};

Message message(std::vector<std::byte> raw, std::span<const Field> fields) {
  return {Direction::kFromDevice, {}, "telemetry", std::move(raw), fields, ""};
}

std::vector<std::byte> bytes(std::initializer_list<int> values) {
  std::vector<std::byte> out;
  for (const int value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

TEST(ToLine, HasDirectionNameAndFields) {
  EXPECT_EQ(to_line(message(bytes({0xFF, 0xFF, 0xFF, 0xFE, 0}), kFew)),
            "from_device telemetry  speed -2 steps/s  state 0");
}

TEST(ToLine, LeavesOutZerosOfLongMessages) {
  std::vector<Field> many;
  for (std::uint16_t i = 0; i < 9; ++i) many.push_back({"abcdefghi", i, 1, Encoding::kUnsigned});
  for (std::size_t i = 0; i < many.size(); ++i) many[i].name = many[i].name.substr(i, 1);
  EXPECT_EQ(to_line(message(bytes({0, 0, 7, 0, 0, 0, 0, 0, 1}), many)),
            "from_device telemetry  c 7  i 1");
}

TEST(ToLine, GivesTheReasonAndTheBytesOfNoise) {
  auto noise = message(bytes({0xAB, 0xCD}), {});
  noise.name = "noise";
  noise.fault = "cut short";
  EXPECT_EQ(to_line(noise), "from_device noise: cut short: AB CD");
}

TEST(ToShortDump, CountsWhatItLeavesOut) {
  EXPECT_EQ(to_short_dump(bytes({1, 2})), "01 02");
  const std::vector<std::byte> twenty(20);
  EXPECT_EQ(to_short_dump(twenty).size(), 3 * 20 - 1U);
  const std::vector<std::byte> many(60, std::byte{0xAA});
  EXPECT_EQ(to_short_dump(many), "AA AA AA AA AA AA AA AA AA AA AA AA AA AA AA AA ... 44 more");
}

TEST(TextInBoth, IsDecimalAndHexadecimal) {
  EXPECT_EQ(text_in_both(kFew[1], 99), "99 steps/s = 0x000063");
  EXPECT_EQ(text_in_both(kFew[1], -2), "-2 steps/s = 0xFFFFFE");
  EXPECT_EQ(text_in_both(kFew[2], 10), "10 = 0x0A");
  EXPECT_EQ(text_in_both({"io", 0, 1, Encoding::kBits, "", ""}, 3), "(0x03)");
}

}  // namespace
}  // namespace armjig
