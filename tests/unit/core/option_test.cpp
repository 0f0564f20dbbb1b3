// SPDX-License-Identifier: Apache-2.0
#include "harness/core/option.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/unit/support/options.hpp"

namespace armjig {
namespace {

struct Settings {
  int mode = 0;
  std::uint8_t size = 5;
  std::int64_t any = 0;
  double ratio = 0.0;
  std::string name;
  std::vector<int> list;
};
constexpr std::array kTable{
    DeviceOption<Settings>{{"mode", "slow|fast|off", "how fast"},
                           [](Settings& settings, const OptionValue& value) {
                             return value.choose(settings.mode, {1, 2, 3});
                           }},
    DeviceOption<Settings>{
        {"size", "0..255", "how large"},
        [](Settings& settings, const OptionValue& value) { return value.take(settings.size); }},
    DeviceOption<Settings>{
        {"any", "..", "any whole number"},
        [](Settings& settings, const OptionValue& value) { return value.take(settings.any); }},
    DeviceOption<Settings>{
        {"ratio", "1e-5..", "how steep"},
        [](Settings& settings, const OptionValue& value) { return value.take(settings.ratio); }},
    DeviceOption<Settings>{
        {"name", "NAME", "how called"},
        [](Settings& settings, const OptionValue& value) { return value.take(settings.name); }},
    DeviceOption<Settings>{{"list", "1..3,...", "how many"},
                           [](Settings& settings, const OptionValue& value) {
                             return value.each([&](const OptionValue& one) {
                               return one.take(settings.list.emplace_back());
                             });
                           }},
};
constexpr auto kRows = rows_of(kTable);

Outcome<Settings> read(const DeviceOptions& options, const std::string& where = "there") {
  return read_options("thing", kTable, options, where, Settings{});
}

std::string complaint(const DeviceOptions& options) {
  const auto settings = read(options);
  return settings ? "" : settings.error().where + ": " + settings.error().hint;
}

TEST(DeviceOptions, ChangeTheSettingsThatTheyName) {
  const auto settings = read(
      {{"mode", "fast"}, {"ratio", "2.5e-1"}, {"name", "a,b"}, {"list", "3,1"}, {"any", "-7"}});
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->mode, 2);
  EXPECT_EQ(settings->size, 5);
  EXPECT_EQ(settings->any, -7);
  EXPECT_EQ(settings->ratio, 0.25);
  EXPECT_EQ(settings->name, "a,b");
  EXPECT_THAT(settings->list, testing::ElementsAre(3, 1));
}

TEST(DeviceOptions, AreTakenAsDocumented) {
  expect_documented_values(kRows,
                           [](const DeviceOptions& options, const std::string& where) {
                             return read(options, where).map([](const Settings&) {});
                           },
                           {{"name", {"x", ""}}});
}

TEST(DeviceOptions, AreRefusedInTheSameWordsForAllDevices) {
  EXPECT_EQ(complaint({{"colour", "red"}}),
            "there, colour: thing has mode, size, any, ratio, name and list");
  EXPECT_EQ(complaint({{"mode", "x"}}), "there, mode=x: write slow, fast or off");
  EXPECT_EQ(complaint({{"rato", "1"}}),
            "there, rato: did you mean 'ratio'? thing has mode, size, any, ratio, name and list");
  EXPECT_EQ(complaint({{"mode", "fats"}}),
            "there, mode=fats: did you mean 'fast'? write slow, fast or off");
  EXPECT_EQ(complaint({{"size", "256"}}), "there, size=256: write a whole number from 0 to 255");
  EXPECT_EQ(complaint({{"size", "1.5"}}), "there, size=1.5: write a whole number from 0 to 255");
  EXPECT_EQ(complaint({{"any", "9223372036854775808"}}),
            "there, any=9223372036854775808: write a whole number");
  EXPECT_EQ(complaint({{"ratio", "0"}}), "there, ratio=0: write a number of at least 1e-5");
  EXPECT_EQ(complaint({{"name", ""}}), "there, name=: write NAME");
  EXPECT_EQ(complaint({{"list", "1,4"}}),
            "there, list=4: write whole numbers from 1 to 3, with commas between");
}

TEST(DeviceOptions, AreATableInMarkdown) {
  EXPECT_EQ(to_markdown(std::span{kRows}.first(2)),
            "| option | meaning |\n|---|---|\n"
            "| `mode=slow\\|fast\\|off` | how fast |\n"
            "| `size=0..255` | how large |\n");
}

}  // namespace
}  // namespace armjig
