// SPDX-License-Identifier: Apache-2.0
// What a suite does, as scripts of a campaign.
#include "cli/fuzz_suite.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "cli/devices/devices.hpp"
#include "cli/fuzz_material.hpp"

namespace armjig::cli {
namespace {

using namespace std::chrono_literals;
using campaign::Script;

class ScriptsOfSuite : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] std::vector<Script> scripts(bool has_hands, Duration longest) const {
    return scripts_of_suite(device_, emulated_, has_hands, longest);
  }

  const Device& device_{**find_device(shipped_devices(), GetParam())};
  const RigOptions emulated_{.target = sound_target({})};
};

bool is_by_hand_somewhere(const Script& script) {
  return std::ranges::any_of(script, campaign::is_by_hand);
}

TEST_P(ScriptsOfSuite, AreShortEnoughAndNeedNoHands) {
  const auto all = scripts(false, 3s);
  EXPECT_GT(all.size(), 50U);
  EXPECT_TRUE(std::ranges::none_of(all, is_by_hand_somewhere));
  EXPECT_TRUE(std::ranges::all_of(all, [](const Script& one) {
    return !one.empty() && campaign::length_of(one) <= 3s && one.front().time == Instant{};
  }));
}

TEST_P(ScriptsOfSuite, LeaveNoConnectionOpen) {
  for (const auto& script : scripts(false, 3s)) EXPECT_EQ(campaign::with_ends(script), script);
}

TEST_P(ScriptsOfSuite, UseHandsThatAreThere) {
  EXPECT_TRUE(std::ranges::any_of(scripts(true, 3s), is_by_hand_somewhere));
}

TEST_P(ScriptsOfSuite, AreTheSameEachTime) { EXPECT_EQ(scripts(false, 1s), scripts(false, 1s)); }

INSTANTIATE_TEST_SUITE_P(Of, ScriptsOfSuite, testing::Values("parol6", "kinovazed", "morap"),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace armjig::cli
