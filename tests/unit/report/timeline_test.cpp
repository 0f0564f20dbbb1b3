// SPDX-License-Identifier: Apache-2.0
#include "harness/report/timeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace armjig {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(TimelineFigure, LinksEachMarkToItsMessage) {
  const Timeline timeline{.title = "t",
                          .seconds = 2,
                          .charts = {{"position", {{"j1", {{0.5, -1, 3}, {1, 1, 1}}}}}},
                          .lanes = {{"states", false, {{1, 1.5, "a -> b", 7}}}},
                          .messages = {{7, 1, "from device", "telemetry", false}},
                          .left_out = ""};
  const auto html = to_figure(timeline);
  EXPECT_THAT(html, HasSubstr("<a href=\"#m7\"><title>1.000000 s a -&gt; b</title>"));
  EXPECT_THAT(html, HasSubstr("<tr id=\"m7\"><td class=\"number\"><a href=\"#m7\">1.000000</a>"));
  // From -1 at the bottom to 3 at the top, then 1 in the middle.
  EXPECT_THAT(html, HasSubstr("d=\"M0.5 1000V0L1 500\""));
}

TEST(TimelineFigure, EscapesWhatADeviceSays) {
  const std::string nasty = "<script>alert(1)</script>\"'&\x1B\xFF";
  const Timeline timeline{.title = nasty,
                          .seconds = 1,
                          .charts = {{nasty, {{nasty, {{0, 0, 1}}}}}},
                          .lanes = {{nasty, true, {{0, 0, nasty, 0}}}},
                          .messages = {{0, 0, nasty, nasty, true}},
                          .left_out = nasty};
  const auto html = to_figure(timeline);
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("\x1B")));
  EXPECT_THAT(html, Not(HasSubstr("\xFF")));
}

}  // namespace
}  // namespace armjig
