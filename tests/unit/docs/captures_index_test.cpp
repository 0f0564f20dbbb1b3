// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

TEST(CapturesIndex, IsWhatScriptsIndexCapturesWrites) {
  // NOLINTNEXTLINE(bugprone-command-processor,concurrency-mt-unsafe): a fixed command of our own
  EXPECT_EQ(std::system(("python3 '" + source_dir() + "/scripts/index-captures' --check").c_str()),
            0);
}

}  // namespace
}  // namespace armjig
