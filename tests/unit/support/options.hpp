// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/option.hpp"

namespace armjig {

/// For options whose values are texts: one that is taken, and one that is refused if there is one.
using TextSamples = std::map<std::string_view, std::pair<std::string, std::string>>;

/// Each row's documented values are taken, what is beside them and unknown names are refused, with
/// one line that names the place.
inline void expect_documented_values(
    std::span<const OptionRow> rows,
    const std::function<Outcome<void>(const DeviceOptions&, const std::string& where)>& make,
    const TextSamples& samples) {
  const auto expect_taken = [&](std::string_view name, const std::string& value) {
    const auto made = make({{std::string{name}, value}}, "here");
    EXPECT_TRUE(made) << name << '=' << value << ": " << describe(made.error());
  };
  const auto expect_refused = [&](std::string_view name, const std::string& value,
                                  ErrorCode code = ErrorCode::kBadValue) {
    const auto made = make({{std::string{name}, value}}, "here");
    ASSERT_FALSE(made) << name << '=' << value;
    EXPECT_EQ(made.error().code, code) << name << '=' << value;
    EXPECT_TRUE(made.error().where.starts_with("here, " + std::string{name}));
    EXPECT_FALSE(made.error().hint.empty());
    EXPECT_EQ(describe(made.error()).find('\n'), std::string::npos);
  };
  const auto expect_range = [&](std::string_view name, std::string_view values) {
    const auto dots = values.find("..");
    const std::string low{values.substr(0, dots)};
    const auto list = values.find(",...");
    const std::string high{values.substr(dots + 2, list - dots - 2)};
    for (const auto& end : {low, high}) {
      if (!end.empty()) expect_taken(name, end);
    }
    if (!low.empty()) expect_refused(name, low.starts_with('-') ? "-1" + low.substr(1) : "-1");
    if (!high.empty()) expect_refused(name, "1" + high);
    for (const auto* wrong : {"nan", "inf", "1x", " 1", "0x1", "1e999"})
      expect_refused(name, wrong);
    if (list != std::string_view::npos) {
      expect_taken(name, low + "," + high);
      for (const auto* wrong : {",", "1,", ",1", "1;2"}) expect_refused(name, wrong);
    }
  };
  for (const auto& [name, values, meaning] : rows) {
    EXPECT_FALSE(meaning.empty()) << name;
    const auto sample = samples.find(name);
    if (sample != samples.end()) {
      const auto& [good, bad] = sample->second;
      expect_taken(name, good);
      if (!bad.empty()) expect_refused(name, bad);
    } else if (values.find("..") != std::string_view::npos) {
      expect_range(name, values);
    } else {
      for (auto rest = values;; rest.remove_prefix(rest.find('|') + 1)) {
        expect_taken(name, std::string{rest.substr(0, rest.find('|'))});
        if (rest.find('|') == std::string_view::npos) break;
      }
    }
    expect_refused(name, "");
    if (sample == samples.end()) expect_refused(name, "none-of-these");
  }
  expect_refused("no-such-option", "1", ErrorCode::kUnknownOption);
}

}  // namespace armjig
