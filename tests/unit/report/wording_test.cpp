// SPDX-License-Identifier: Apache-2.0
#include "harness/report/wording.hpp"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include <nlohmann/json.hpp>

#include "tests/unit/report/sample_report.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig::wording {
namespace {

using namespace std::string_literals;
using ::testing::ElementsAre;

TEST(Wording, ShowsBytesThatCannotStay) {
  EXPECT_EQ(line("a\x1b[31mb\x7F\r\n\t\0c"s), R"(a\x1B[31mb\x7F\r\n\t\x00c)");
}

TEST(Wording, KeepsLinesWhereTheyAreWanted) { EXPECT_EQ(lines("a\r\n\tb"), "a\\r\n\tb"); }

TEST(Wording, ShowsBytesThatAreNoUtf8) {
  EXPECT_EQ(line("\x80|\xC0\xAF|\xE2\x82|\xED\xA0\x80|\xF4\x90\x80\x80|\xFF"),
            R"(\x80|\xC0\xAF|\xE2\x82|\xED\xA0\x80|\xF4\x90\x80\x80|\xFF)");
}

TEST(Wording, ShowsWhatTerminalsObeyOrXmlForbids) {
  EXPECT_EQ(line("\xC2\x9B|\xEF\xBF\xBE|\xEF\xBF\xBF"), R"(\xC2\x9B|\xEF\xBF\xBE|\xEF\xBF\xBF)");
}

TEST(Wording, KeepsWhatPeopleWrite) {
  const auto text = "µ ü ² € \xF0\x9F\xA6\xBE \xEF\xBF\xBD \xC2\xA0"s;
  EXPECT_EQ(line(text), text);
}

TEST(Wording, IsGoodUtf8WithoutControlsWhateverComes) {
  test::for_all([](const std::string& bytes) {
    const auto shown = line(bytes);
    (void)nlohmann::json(shown).dump();  // throws on bad UTF-8
    for (const char c : shown) RC_ASSERT(static_cast<unsigned char>(c) >= 0x20 && c != 0x7F);
    RC_ASSERT(line(shown) == shown);
  });
}

TEST(Wording, EscapesMarkup) {
  EXPECT_EQ(html("<a b=\"c\" d='e'>&]]>\x01"),
            "&lt;a b=&quot;c&quot; d=&apos;e&apos;&gt;&amp;]]&gt;\\x01");
}

TEST(Wording, GroupsRowsByDeviceAndTopic) {
  Report report;
  for (const auto* name : {"parol6.frame.burst", "parol6.alive", "plain",
                           "parol6.estop.latch.again", "parol6.frame.noise"}) {
    report.rows.emplace_back().name = name;
  }
  const auto topics = topics_of(report);
  std::vector<std::string_view> names;
  for (const auto& topic : topics) names.push_back(topic.name);
  EXPECT_THAT(names, ElementsAre("parol6.frame", "parol6", "plain", "parol6.estop"));
  EXPECT_THAT(topics[0].rows, ElementsAre(&report.rows[0], &report.rows[4]));
}

TEST(Wording, WritesTimesInUtc) {
  EXPECT_EQ(iso_time(*test::drive_report().started), "2026-03-29T14:05:09");
}

}  // namespace
}  // namespace armjig::wording
