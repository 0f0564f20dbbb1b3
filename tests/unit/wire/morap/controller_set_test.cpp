// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/morap/controller_set.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <string_view>

#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig::morap {
namespace {

using test::as_vector;
using test::hex;

// docs/spec/morap.md, worked examples: without the identifier, checksum last.
constexpr std::array<std::string_view, 8> kExamples{
    "00C80002EC51E6C10000F84102EC51E6C10000F84101E10B63BF00000000DF",
    "00710202CE19C9BF86C9104002CE19C9BF86C9104001C7BA78BF00000000A8",
    "01F40102FE65773DFE65773D02A54E80BF3C4ED13F01D04418BFB515FB3E10",
    "00000000000000000000FF",
    "00C80001000020410100002041010000000000000000 71",
    "007102"
    "04CDCCCC3DCDCC4C3E9A99993ECDCCCC3E040000003F9A99193F3333333FCDCC4C3F"
    "04CDCCCCBDCDCC4CBE9A9999BECDCCCCBE0AD7233C7B",
    "FFFFFF0000000000000000",  // folds to FF, so the checksum is 0
    "00FFFF0000000000FF02FD",  // folds twice
};

TEST(ControllerSet, ExamplesDecodeAndEncodeToThemselves) {
  for (const auto text : kExamples) {
    const auto bytes = hex(text);
    const auto decoded = decode_set(bytes);
    const auto* set = std::get_if<ControllerSet>(&decoded);
    ASSERT_NE(set, nullptr) << text;
    EXPECT_EQ(wire_size(*set), bytes.size()) << text;
    EXPECT_EQ(as_vector(encode(*set).view()), bytes) << text;
  }
}

TEST(ControllerSet, HasTheValuesOfTheStoredPositionController) {
  const auto decoded = decode_set(hex(kExamples[1]));
  const auto& set = std::get<ControllerSet>(decoded);
  EXPECT_EQ(set.kind, ControllerKind::kPosition);
  EXPECT_EQ(set.rate_hz, 625);
  EXPECT_EQ(set.d.count, 2);
  EXPECT_EQ(set.d.values[0], -1.5711F);
  EXPECT_EQ(set.c.values[1], 2.2623F);
  EXPECT_EQ(set.f.count, 1);
  EXPECT_EQ(set.f.values[0], -0.9716F);
  EXPECT_EQ(set.integral, 0.0F);
}

TEST(ControllerSet, CutShortAnywhereIsTooShort) {
  const auto bytes = hex(kExamples[5]);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto decoded = decode_set(Bytes{bytes}.first(size));
    const SetFault expected{SetFault::Kind::kTooShort, size};
    ASSERT_TRUE(std::holds_alternative<SetFault>(decoded)) << size;
    EXPECT_EQ(std::get<SetFault>(decoded), expected);
  }
}

TEST(ControllerSet, RefusesACountAboveFourWithoutTheRest) {
  const auto refused_at = [](std::string_view text) {
    return std::get<SetFault>(decode_set(hex(text)));
  };
  EXPECT_EQ(refused_at("00C80005"), (SetFault{SetFault::Kind::kCountAboveFour, 3}));
  EXPECT_EQ(refused_at("00C8000005"), (SetFault{SetFault::Kind::kCountAboveFour, 4}));
  EXPECT_EQ(refused_at("00C8000000FF"), (SetFault{SetFault::Kind::kCountAboveFour, 5}));
}

TEST(ControllerSet, EveryByteCountsInTheChecksum) {
  const auto bytes = hex(kExamples[2]);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto wrong = bytes;
    wrong[i] ^= std::byte{0x40};
    const auto decoded = decode_set(wrong);
    EXPECT_TRUE(std::holds_alternative<SetFault>(decoded)) << i;
  }
}

TEST(Checksum, CannotTellZeroesFromOnesUnlessAllIsZero) {
  EXPECT_EQ(checksum(hex("00 12")), checksum(hex("FF 12")));
  EXPECT_EQ(checksum(hex("00 00")), 0xFF);
  EXPECT_EQ(checksum(hex("FF 00")), 0x00);
}

ControllerSet random_set() {
  const auto filter = [] {
    Coefficients coefficients{*rc::gen::inRange<std::uint8_t>(0, 5), {}};
    for (std::size_t i = 0; i < coefficients.count; ++i) {
      coefficients.values[i] = std::bit_cast<float>(*rc::gen::arbitrary<std::uint32_t>());
    }
    return coefficients;
  };
  return {ControllerKind{*rc::gen::arbitrary<std::uint8_t>()},
          *rc::gen::arbitrary<std::uint16_t>(),
          filter(),
          filter(),
          filter(),
          std::bit_cast<float>(*rc::gen::arbitrary<std::uint32_t>())};
}

TEST(ControllerSet, AnyBitPatternsSurviveTheWire) {
  test::for_all([] {
    const auto bytes = encode(random_set());
    const auto decoded = decode_set(bytes);
    RC_ASSERT(std::holds_alternative<ControllerSet>(decoded));
    RC_ASSERT(as_vector(encode(std::get<ControllerSet>(decoded)).view()) ==
              as_vector(bytes.view()));
  });
}

}  // namespace
}  // namespace armjig::morap
