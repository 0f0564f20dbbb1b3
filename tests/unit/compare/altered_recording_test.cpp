// SPDX-License-Identifier: Apache-2.0
// Who compares is tried by what has to be found: a byte, a length, a time or an acknowledge that is
// changed somewhere in a recording. A small sample; tests/integration/alterations_soak.cpp has
// more.
#include "tests/unit/compare/altered_recording.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/support/source_dir.hpp"

namespace armjig::test {
namespace {

class AlteredRecordings : public ::testing::TestWithParam<const char*> {};

TEST_P(AlteredRecordings, AreFoundAndNamed) {
  AlteredCorpus corpus{fmt::format("{}/captures/{}", source_dir(), GetParam())};
  ASSERT_FALSE(corpus.is_empty());
  for (std::uint64_t seed = 1; seed <= 25; ++seed) EXPECT_EQ(corpus.complaint(seed), "");
}

INSTANTIATE_TEST_SUITE_P(Golden, AlteredRecordings,
                         ::testing::Values("demo", "kinovazed", "morap", "parol6"),
                         [](const auto& sample) { return std::string{sample.param}; });

}  // namespace
}  // namespace armjig::test
