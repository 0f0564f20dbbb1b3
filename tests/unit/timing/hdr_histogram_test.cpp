// SPDX-License-Identifier: Apache-2.0
// The layout, correction and log format of HdrHistogram 2.1. Ranges and percentiles are those that
// its authors publish in the tests of their library; texts were written by its Java library
// (Debian's libhdrhistogram-java 2.1.11), whose log processor has also read ours.
#include <gtest/gtest.h>

#include <chrono>

#include "harness/timing/histogram_log.hpp"
#include "harness/timing/latency_histogram.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

Duration first_beside(Duration value) {
  return LatencyHistogram::first_of(LatencyHistogram::bucket_of(value));
}
Duration last_beside(Duration value) {
  return LatencyHistogram::last_of(LatencyHistogram::bucket_of(value));
}

TEST(HdrHistogram, PutsValuesIntoThePublishedRanges) {
  EXPECT_EQ(first_beside(10'007ns), 10'000ns);
  EXPECT_EQ(first_beside(10'009ns), 10'008ns);
  EXPECT_EQ(last_beside(8'180ns), 8'183ns);
  EXPECT_EQ(last_beside(8'191ns), 8'191ns);
  EXPECT_EQ(last_beside(8'193ns), 8'199ns);
  EXPECT_EQ(last_beside(9'995ns), 9'999ns);
  EXPECT_EQ(last_beside(10'007ns), 10'007ns);
  EXPECT_EQ(last_beside(10'008ns), 10'015ns);
  EXPECT_EQ(last_beside(2'047ns), 2'047ns);
  EXPECT_EQ(last_beside(2'500ns) - first_beside(2'500ns), 1ns);
}

TEST(HdrHistogram, BucketsFollowEachOtherWithoutGap) {
  const LatencyHistogram histogram;
  for (std::size_t i = 1; i < histogram.counts().size(); ++i) {
    ASSERT_EQ(LatencyHistogram::first_of(i), LatencyHistogram::last_of(i - 1) + 1ns) << i;
    ASSERT_EQ(LatencyHistogram::bucket_of(
                  std::min(LatencyHistogram::first_of(i), LatencyHistogram::kLongest)),
              std::min(i, LatencyHistogram::bucket_of(LatencyHistogram::kLongest)));
  }
}

/// The published example, in microseconds: 10,000 answers after 1 ms, then one after 100 s, and one
/// was due each 10 ms.
TEST(HdrHistogram, CorrectsTheCoordinatedOmissionOfThePublishedExample) {
  LatencyHistogram raw;
  LatencyHistogram corrected;
  for (int i = 0; i < 10'000; ++i) {
    raw.record(1'000ns);
    corrected.record_corrected(1'000ns, 10'000ns);
  }
  raw.record(100'000'000ns);
  corrected.record_corrected(100'000'000ns, 10'000ns);
  EXPECT_EQ(raw.count(), 10'001U);
  EXPECT_EQ(corrected.count(), 20'000U);
  const auto is_about = [](Duration actual, double wanted) {
    EXPECT_NEAR(static_cast<double>(actual.count()), wanted, wanted * 0.001);
  };
  for (const double percent : {30.0, 99.0, 99.99}) is_about(raw.percentile(percent), 1'000);
  for (const double percent : {99.999, 100.0}) is_about(raw.percentile(percent), 1e8);
  is_about(corrected.percentile(30), 1'000);
  is_about(corrected.percentile(50), 1'000);
  is_about(corrected.percentile(75), 5e7);
  is_about(corrected.percentile(90), 8e7);
  is_about(corrected.percentile(99), 9.8e7);
  is_about(corrected.percentile(99.999), 1e8);
  is_about(raw.mean(), (1'000.0 * 10'000 + 1e8) / 10'001);
  is_about(corrected.mean(), (1'000.0 * 10'000 + 5e7 * 10'000) / 20'000);
}

constexpr std::string_view kTheirs =
    "HISTFAAAADF42pNpmSzMwMDAzwABzFCaEch0M9ixgMH+A0SAiZtp4zrGBXMYl0YynRRlAgC0wQjm";

/// What is in there.
LatencyHistogram theirs() {
  LatencyHistogram histogram;
  histogram.record(1ms, 10'000);
  for (const auto value : {0ns, 7ns, 50'000'000ns, 123'456'789ns}) histogram.record(value);
  return histogram;
}

void expect_same(const LatencyHistogram& left, const LatencyHistogram& right) {
  EXPECT_EQ(left.count(), right.count());
  EXPECT_TRUE(std::ranges::equal(left.counts(), right.counts()));
}

TEST(HdrText, ReadsWhatTheJavaLibraryWrites) {
  const auto read = parse_hdr_text(kTheirs);
  ASSERT_TRUE(read);
  expect_same(*read, theirs());
}

TEST(HdrText, ReadsWhatItWrites) {
  expect_same(*parse_hdr_text(to_hdr_text(theirs())), theirs());
  expect_same(*parse_hdr_text(to_hdr_text({})), {});
  LatencyHistogram far;
  far.record(Duration::max(), std::uint64_t{1} << 62U);
  expect_same(*parse_hdr_text(to_hdr_text(far)), far);
}

TEST(HdrText, RefusesWhatIsCutAnywhereOrOfAnotherKind) {
  for (std::size_t size = 0; size + 2 < kTheirs.size(); ++size) {
    EXPECT_FALSE(parse_hdr_text(kTheirs.substr(0, size))) << size;
  }
  EXPECT_FALSE(parse_hdr_text("HISTEAAAADF42pNpmSzMwMDAzwABzFCaEch0"));
  EXPECT_FALSE(parse_hdr_text("no histogram"));
}

TEST(HistogramLog, ReadsALogOfTheJavaLibrary) {
  const auto log = parse_histogram_log(
      "#[Histogram log format version 1.3]\n"
      "#[StartTime: 1700000000.000 (seconds since epoch), Tue Nov 14 22:13:20 UTC 2023]\n"
      "\"StartTimestamp\",\"Interval_Length\",\"Interval_Max\",\"Interval_Compressed_Histogram\"\n"
      "0.500,10.000,123.470," +
      std::string{kTheirs} + "\r\nTag=load,11,1,123.47," + std::string{kTheirs} + "\n");
  ASSERT_TRUE(log);
  ASSERT_EQ(log->size(), 2U);
  EXPECT_EQ(log->front().start, 0.5s);
  EXPECT_EQ(log->front().length, 10s);
  EXPECT_EQ(log->front().tag, "");
  EXPECT_EQ(log->back().tag, "load");
  expect_same(log->back().histogram, theirs());
}

TEST(HistogramLog, ReadsWhatItWritesAndNamesTheLineThatIsNone) {
  const auto started = std::chrono::sys_seconds{1'700'000'000s};
  const auto text =
      to_histogram_log(started, {{"", 0s, 1s, theirs()}, {"target", 1s, 2.5s, theirs()}});
  EXPECT_NE(text.find("#[StartTime: 1700000000.000 (seconds since epoch), 2023-11-14T22:13:20Z]"),
            std::string::npos);
  const auto log = parse_histogram_log(text);
  ASSERT_TRUE(log);
  ASSERT_EQ(log->size(), 2U);
  EXPECT_EQ(log->back().tag, "target");
  EXPECT_EQ(log->back().length, 2.5s);
  expect_same(log->front().histogram, theirs());
  const auto bad = parse_histogram_log(text + "1,2,3\n");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error(), (Error{ErrorCode::kMalformed, 7}));
}

}  // namespace
}  // namespace armjig
