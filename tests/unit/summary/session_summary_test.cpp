// SPDX-License-Identifier: Apache-2.0
#include "harness/summary/session_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/fields.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using test::hex;
using ::testing::HasSubstr;

const CaptureLink kArm{"arm", "parol6", LinkKind::kStream};
const CaptureLink kServer{"server", "unknown", LinkKind::kSession};

SessionSummary make_summary() {
  return SessionSummary{[](std::string_view device) -> MakeDissector {
    return device == "parol6" ? parol6::make_dissector : nullptr;
  }};
}

CaptureRecord record(const CaptureLink& link, Instant time, Direction direction, Bytes bytes) {
  return {
      .time = time, .link = &link, .direction = direction, .id = 0, .bytes = bytes, .details = {}};
}

TEST(SessionSummary, CountsBothDirectionsGapsAndRoundTrips) {
  auto summary = make_summary();
  const auto bytes = hex("01 02 03");
  for (const auto begin : {0ms, 10ms, 110ms}) {
    summary.add(record(kServer, at(begin), Direction::kToDevice, bytes));
    summary.add(record(kServer, at(begin + 2ms), Direction::kFromDevice, bytes));
  }
  summary.finish();
  EXPECT_FALSE(summary.has_findings());
  const auto json = nlohmann::json::parse(summary.to_json());
  const auto& link = json["links"][0];
  EXPECT_EQ(link["to_device"]["records"], 3);
  EXPECT_EQ(link["to_device"]["bytes"], 9);
  EXPECT_EQ(link["to_device"]["longest_gap_ms"], 100.0);
  EXPECT_EQ(link["round_trips"]["count"], 3);
  EXPECT_EQ(link["round_trips"]["max_ms"], 2.0);
  EXPECT_THAT(summary.to_text(), HasSubstr("0.112 s, 6 records"));
}

TEST(SessionSummary, SaysWhatMovedAndWhatWasNoMessage) {
  auto summary = make_summary();
  auto telemetry = parol6::vectors::kRestTelemetry;
  const auto* const position = find_field(parol6::telemetry_fields(), "position.j1");
  ASSERT_NE(position, nullptr);
  for (const auto steps : {0, 700, -30}) {
    set_field_value(*position, telemetry, steps);
    summary.add(record(kArm, at(10ms), Direction::kFromDevice, telemetry));
  }
  summary.add(record(kArm, at(20ms), Direction::kFromDevice, hex("12 34")));
  summary.finish();
  EXPECT_TRUE(summary.has_findings());
  const auto text = summary.to_text();
  EXPECT_THAT(text, HasSubstr("position.j1: -30 steps to 700 steps, last -30 steps"));
  EXPECT_THAT(text, HasSubstr("3 x telemetry"));
  EXPECT_THAT(text, HasSubstr("findings     1 x from_device: "));
}

}  // namespace
}  // namespace armjig
