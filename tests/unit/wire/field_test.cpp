// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/field.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/unit/support/bytes.hpp"

namespace armjig {
namespace {

using test::hex;
using enum Encoding;

constexpr std::array<std::string_view, 8> kBitNames{"top", "", "third", "", "", "", "", "low"};
constexpr std::array<NamedValue, 2> kNames{{{1, "one"}, {255, "all"}}};
constexpr Field kUnsignedField{"u", 1, 2, kUnsigned, "ticks", ""};
constexpr Field kSignedField{"s", 1, 3, kSigned, "steps", ""};
constexpr Field kPlainField{"p", 0, 1, kUnsigned, "", ""};
constexpr Field kBitsField{"b", 0, 1, kBits, "", "", kBitNames};
constexpr Field kCodeField{"c", 0, 1, kCode, "", "", {}, kNames};
constexpr Field kLiteralField{"l", 0, 3, kLiteral, "", "", {}, {}, 0xFFFFFF};

TEST(Field, ReadsBigEndianNumbersOfItsWidth) {
  EXPECT_EQ(field_value(kUnsignedField, hex("00 FF 38")), 0xFF38);
  EXPECT_EQ(field_value(kSignedField, hex("00 FF 83 00")), -32000);  // F1
  EXPECT_EQ(field_value(kSignedField, hex("00 00 E2 31")), 57905);   // F1
  EXPECT_EQ(field_value(kBitsField, hex("8F")), 0x8F);
  EXPECT_EQ(field_value(kCodeField, hex("FF")), 255);
  EXPECT_EQ(field_value(kLiteralField, hex("FF FF FE")), 0xFFFFFE);
}

TEST(Field, WritesTheLowBytesOfAValueAndNothingElse) {
  auto message = hex("11 22 33 44 55");
  set_field_value(kSignedField, message, -32000);
  EXPECT_EQ(message, hex("11 FF 83 00 55"));
  set_field_value(kSignedField, message, 16777216 + 5);  // F1: the rest is lost
  EXPECT_EQ(message, hex("11 00 00 05 55"));
}

TEST(Field, SaysANumberWithItsUnit) {
  EXPECT_EQ(field_text(kSignedField, -3000), "-3000 steps");
  EXPECT_EQ(field_text(kPlainField, 7), "7");
}

TEST(Field, NamesFlagsFromBitSevenDownAndKeepsTheByte) {
  EXPECT_EQ(field_text(kBitsField, 0xA1), "top third low (0xA1)");
  EXPECT_EQ(field_text(kBitsField, 0x00), "(0x00)");
  EXPECT_EQ(field_text(kBitsField, 0x40), "(0x40)");
}

TEST(Field, KeepsTheNumberOfAValueWithoutAName) {
  EXPECT_EQ(field_text(kCodeField, 1), "1 (one)");
  EXPECT_EQ(field_text(kCodeField, 42), "42");
}

TEST(Field, SaysALiteralInAllItsDigits) { EXPECT_EQ(field_text(kLiteralField, 0x102), "0x000102"); }

TEST(Field, IsFoundByItsName) {
  constexpr std::array kFields{kUnsignedField, kSignedField};
  EXPECT_EQ(find_field(kFields, "s"), &kFields[1]);
  EXPECT_EQ(find_field(kFields, "x"), nullptr);
}

}  // namespace
}  // namespace armjig
