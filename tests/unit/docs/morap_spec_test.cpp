// SPDX-License-Identifier: Apache-2.0
// docs/spec/morap.md has the sentences of the catalogue, with their sources, and no others.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "conformance/morap/suite.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig::morap::conformance {
namespace {

/// The page with every run of blanks and line ends as one blank.
std::string page_in_one_line() {
  std::ifstream in{source_dir() + "/docs/spec/morap.md", std::ios::binary};
  const std::string text{std::istreambuf_iterator<char>{in}, {}};
  return std::regex_replace(text, std::regex{R"(\s+)"}, " ");
}

std::set<std::string> named_in(const std::string& page) {
  const std::regex name{R"(\*\*`(morap\.[a-z0-9.-]+)`\*\*)"};
  std::set<std::string> names;
  for (std::sregex_iterator it{page.begin(), page.end(), name}, end; it != end; ++it) {
    names.insert((*it)[1]);
  }
  return names;
}

TEST(MorapPage, HasTheSentencesOfTheCatalogueAndNoOthers) {
  const auto page = page_in_one_line();
  std::set<std::string> ids;
  for (const auto& chapter : suite().chapters) {
    for (const auto& requirement : chapter.requirements) {
      ids.emplace(requirement.id);
      const auto holder = requirement.role == Role::kHost ? to_string(Role::kHost)
                                                          : to_string(requirement.profiles);
      const auto sentence =
          fmt::format("**`{}`** {} ({}; {}; {})", requirement.id, requirement.text,
                      to_string(requirement.level), requirement.source, holder);
      EXPECT_NE(page.find(sentence), std::string::npos) << sentence;
    }
  }
  EXPECT_EQ(named_in(page), ids);
}

}  // namespace
}  // namespace armjig::morap::conformance
