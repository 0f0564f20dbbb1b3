// SPDX-License-Identifier: Apache-2.0
// A few recordings of each device, replayed to hosted emulated ones over real links; all of them
// are a soak.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <future>
#include <string>
#include <vector>

#include "tests/integration/support/hosted_replay.hpp"

namespace armjig::testing {
namespace {

struct Sample {
  const char* device;
  std::vector<const char*> recordings;
};

void PrintTo(const Sample& sample, std::ostream* out) { *out << sample.device; }

class HostedReplays : public ::testing::TestWithParam<Sample> {};

TEST_P(HostedReplays, AreAsRecorded) {
  const auto& [device, recordings] = GetParam();
  std::vector<std::future<Outcome<HostedReplay>>> replays;
  for (const auto* const name : recordings) {
    replays.push_back(std::async(std::launch::async, [=] {
      return replay_hosted(device,
                           fmt::format("{}/captures/{}/{}.jsonl", ARMJIG_SOURCE_DIR, device, name));
    }));
  }
  for (std::size_t i = 0; i < replays.size(); ++i) {
    const auto replayed = replays[i].get();
    ASSERT_TRUE(replayed) << recordings[i] << ": " << describe(replayed.error());
    EXPECT_GT(replayed->messages, 0U) << recordings[i];
    EXPECT_EQ(replayed->differences, 0U) << recordings[i] << ": " << replayed->first;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Corpus, HostedReplays,
    ::testing::Values(Sample{"parol6",
                             {"unknown_sweep_a", "framing_crc_any_a", "framing_truncated_a"}},
                      Sample{"kinovazed", {"estop-flap", "framing-crlf", "connection-rst"}},
                      Sample{"morap", {"static-boot-defaults", "stim-encoder-angle", "bus-scan"}}),
    ::testing::PrintToStringParamName());

}  // namespace
}  // namespace armjig::testing
