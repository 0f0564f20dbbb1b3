// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/morap/parameter_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <string>

namespace armjig::morap::drive {
namespace {

using ::testing::HasSubstr;

const std::string kFile =
    "controller = \"speed\"\nrate_hz = 400\nd = [0.5, -1]\nc = [2]\nf = [0.25]\nintegral = 0.75\n";

std::string without(const std::string& line_start) {
  auto text = kFile;
  const auto start = text.find(line_start);
  return text.erase(start, text.find('\n', start) + 1 - start);
}

TEST(ParameterFile, IsReadAsItIsWritten) {
  const auto set = parse_parameters(kFile, "a.toml").value();
  EXPECT_EQ(set.kind, ControllerKind::kSpeed);
  EXPECT_EQ(set.rate_hz, 400);
  EXPECT_EQ(set.d.count, 2);
  EXPECT_EQ(set.d.values[1], -1.0F);
  EXPECT_EQ(set.c.count, 1);
  EXPECT_EQ(set.integral, 0.75F);
}

RC_GTEST_PROP(ParameterFile, KeepsEveryBitOfEveryNumber, ()) {
  ControllerSet set;
  set.rate_hz = 1;
  for (auto* filter : {&set.d, &set.c, &set.f}) {
    filter->count = *rc::gen::inRange<std::uint8_t>(1, 5);
    for (std::size_t i = 0; i < filter->count; ++i) {
      const auto bits = *rc::gen::arbitrary<std::uint32_t>();
      const auto value = std::bit_cast<float>(bits);
      filter->values[i] = std::isnan(value) ? 0.0F : value;
    }
  }
  const auto read = parse_parameters(to_toml(set), "a.toml").value();
  RC_ASSERT(std::ranges::equal(encode(read).view(), encode(set).view()));
}

TEST(ParameterFile, NeedsControllerRateAndCoefficients) {
  for (const auto* key : {"controller", "rate_hz", "d =", "c =", "f ="}) {
    const auto set = parse_parameters(without(key), "a.toml");
    ASSERT_FALSE(set) << key;
    EXPECT_EQ(set.error().code, ErrorCode::kMalformed) << key;
  }
  EXPECT_TRUE(parse_parameters(without("integral"), "a.toml"));
}

TEST(ParameterFile, HasOneToFourCoefficients) {
  for (const auto* list : {"f = []", "f = [1, 2, 3, 4, 5]", "f = 1", "f = [\"1\"]"}) {
    const auto set = parse_parameters(without("f =") + list + "\n", "a.toml");
    ASSERT_FALSE(set) << list;
    EXPECT_EQ(set.error().where, "a.toml:6") << list;
    EXPECT_THAT(set.error().hint, HasSubstr("f has to be a list")) << list;
  }
}

TEST(ParameterFile, RefusesARateThatTheWireCannotSay) {
  for (const auto* rate : {"0", "65536", "-1", "400.5"}) {
    EXPECT_FALSE(parse_parameters(without("rate_hz") + "rate_hz = " + rate + "\n", "a.toml"))
        << rate;
  }
}

}  // namespace
}  // namespace armjig::morap::drive
