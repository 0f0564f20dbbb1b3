// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/options.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/support/options.hpp"

namespace armjig::kinovazed::emulation {
namespace {

TEST(KinovazedOptions, TakeTheirDocumentedValues) {
  const OptionFiles files{
      .read_text = [](const std::string&) -> Outcome<std::string> { return "[]"; }};
  expect_documented_values(
      options(),
      [&](const DeviceOptions& given, const std::string& where) {
        return make(given, where, files).map([](const auto&) {});
      },
      {{"fault", {"missing:Unfolded,twice:Unfolded", "missing"}}, {"objectives", {"a.json", ""}}});
}

TEST(KinovazedOptions, NameTheFileThatCannotBeUsed) {
  const auto where_of = [](const char* text) {
    const OptionFiles files{
        .read_text = [&](const std::string&) -> Outcome<std::string> { return text; }};
    return make({{"objectives", "a.json"}}, "emulated:", files).error().where;
  };
  EXPECT_TRUE(where_of("{}").starts_with("a.json"));
  EXPECT_EQ(make({{"objectives", "a.json"}}, "emulated:").error().code, ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace armjig::kinovazed::emulation
