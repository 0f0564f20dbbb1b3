// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>

namespace armjig {
namespace {

TEST(CapturesIndex, IsWhatScriptsIndexCapturesWrites) {
  // NOLINTNEXTLINE(bugprone-command-processor,concurrency-mt-unsafe): a fixed command of our own
  EXPECT_EQ(std::system("python3 '" ARMJIG_SOURCE_DIR "/scripts/index-captures' --check"), 0);
}

}  // namespace
}  // namespace armjig
