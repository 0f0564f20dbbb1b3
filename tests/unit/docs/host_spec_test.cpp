// SPDX-License-Identifier: Apache-2.0
// docs/spec/parol6.md has the sentence of every requirement of programs.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "conformance/parol6/chapters.hpp"
#include "conformance/parol6/host/check.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig::parol6::programs {
namespace {

/// The page with every run of blanks and line ends as one blank.
std::string page_in_one_line() {
  std::ifstream in{source_dir() + "/docs/spec/parol6.md", std::ios::binary};
  const std::string text{std::istreambuf_iterator<char>{in}, {}};
  return std::regex_replace(text, std::regex{"\\s+"}, " ");
}

TEST(HostProgramsSection, HasTheSentenceAndTheSourceOfEveryRequirement) {
  const auto page = page_in_one_line();
  for (const auto& requirement : host_requirements()) {
    const auto sentence = "**`" + std::string{requirement.id} + "`** " +
                          std::string{requirement.text} + " (" +
                          std::string{to_string(requirement.level)} + "; " +
                          std::string{requirement.source} + "; host)";
    EXPECT_NE(page.find(sentence), std::string::npos) << sentence;
  }
}

}  // namespace
}  // namespace armjig::parol6::programs
