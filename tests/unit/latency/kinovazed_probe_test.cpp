// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/kinovazed_probe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "harness/latency/meter.hpp"
#include "harness/rig/stream_link.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

class KinovaProbe : public testing::Test {
 protected:
  void say(std::string_view line, Duration patience) {
    ASSERT_TRUE(link_.port().write(std::as_bytes(std::span{line})));
    const auto end = link_.port().now() + patience;
    std::array<std::byte, 256> heard;
    while (link_.port().now() < end) (void)link_.port().read(heard, end);
  }

  std::vector<Figure> measure(std::uint64_t count) {
    const auto path = path_through(link_.port());
    // An arm takes some time to do both.
    Meter meter{*path, *probe_, {.period = 500ms}, [] { return false; }};
    EXPECT_TRUE(meter.run({.count = count}).value());
    EXPECT_EQ(meter.measured().round_trips.count(), count);
    return probe_->figures({});
  }

  cli::ProbedLink opened_ =
      cli::open_probe(test::device("kinovazed"), {.target = parse_target("emulated:").value()})
          .value();
  StreamLink& link_ = opened_.link;
  std::unique_ptr<Probe>& probe_ = opened_.probe;
};

/// None: it is not among them.
std::optional<double> value_of(const std::vector<Figure>& figures, std::string_view name) {
  const auto found = std::ranges::find(figures, name, &Figure::name);
  if (found == figures.end()) return std::nullopt;
  return found->value;
}

TEST_F(KinovaProbe, TimesFreezeAndUnfreezeToTheirEventsOnAnArmThatIsReady) {
  say("QuitEStop\r\n", 1s);
  say("Initialize\r\n", 6s);
  ASSERT_TRUE(probe_->choose("freeze"));
  const auto figures = measure(20);
  const auto freeze = value_of(figures, "Freeze to Freezed, most");
  ASSERT_TRUE(freeze);
  EXPECT_GT(*freeze, 0);
  EXPECT_LT(*freeze, 500);
  // The server says Unfreezed together with Accepted.
  EXPECT_EQ(value_of(figures, "Unfreeze to Unfreezed, most"), 0.0);
}

TEST_F(KinovaProbe, TimesNothingToAnEventThatDoesNotCome) {
  ASSERT_TRUE(probe_->choose("freeze"));
  EXPECT_FALSE(value_of(measure(20), "Freeze to Freezed, most")) << "an arm that is not ready";
}

TEST_F(KinovaProbe, SaysWhatElseThereIsToMeasure) {
  const auto chosen = probe_->choose("thaw");
  ASSERT_FALSE(chosen);
  EXPECT_THAT(chosen.error().hint, testing::HasSubstr("freeze"));
}

}  // namespace
}  // namespace armjig
