// SPDX-License-Identifier: Apache-2.0
#include "harness/core/hex.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/unit/support/property.hpp"

namespace armjig {
namespace {

constexpr std::array kBytes{std::byte{0x00}, std::byte{0x0F}, std::byte{0xA5}, std::byte{0xFF}};

TEST(Hex, WritesLowerCaseWithoutSeparatorsForFiles) { EXPECT_EQ(to_hex(kBytes), "000fa5ff"); }

TEST(Hex, WritesUpperCasePairsForPeople) { EXPECT_EQ(to_hex_dump(kBytes), "00 0F A5 FF"); }

TEST(Hex, WritesNothingForNoBytes) {
  EXPECT_EQ(to_hex({}), "");
  EXPECT_EQ(to_hex_dump({}), "");
}

TEST(Hex, ReadsEitherCase) {
  const std::vector<std::byte> expected(kBytes.begin(), kBytes.end());
  EXPECT_EQ(from_hex("000fa5ff"), expected);
  EXPECT_EQ(from_hex("000FA5fF"), expected);
}

TEST(Hex, ReadsNothingFromBlanks) { EXPECT_EQ(from_hex(" \t\r\n"), std::vector<std::byte>{}); }

TEST(Hex, PassesOverSeparatorsBetweenBytes) {
  const std::vector<std::byte> expected(kBytes.begin(), kBytes.end());
  EXPECT_EQ(from_hex("00 0F\tA5\r\nFF\n"), expected);
  EXPECT_EQ(from_hex("00:0f,a5, ff"), expected);
  EXPECT_EQ(from_hex("0x00, 0x0F, 0xa5, 0XFF"), expected);
}

TEST(Hex, NamesThePlaceOfTheFirstBadDigit) {
  EXPECT_EQ(from_hex("00 0G"), fail(ErrorCode::kBadHex, 4));
  EXPECT_EQ(from_hex("zz"), fail(ErrorCode::kBadHex, 0));
  EXPECT_EQ(from_hex("00;01"), fail(ErrorCode::kBadHex, 2));
}

TEST(Hex, NamesThePlaceWhereADigitMissesItsPartner) {
  EXPECT_EQ(from_hex("0 0"), fail(ErrorCode::kOddHex, 1));
  EXPECT_EQ(from_hex("00 f:f"), fail(ErrorCode::kOddHex, 4));
  EXPECT_EQ(from_hex("000"), fail(ErrorCode::kOddHex, 3));
  EXPECT_EQ(from_hex("0"), fail(ErrorCode::kOddHex, 1));
}

TEST(Hex, ReadsWhatItWrites) {
  test::for_all([](const std::vector<std::uint8_t>& numbers) {
    std::vector<std::byte> bytes;
    for (const auto number : numbers) bytes.push_back(std::byte{number});
    RC_ASSERT(from_hex(to_hex(bytes)).value() == bytes);
    RC_ASSERT(from_hex(to_hex_dump(bytes)).value() == bytes);
  });
}

}  // namespace
}  // namespace armjig
