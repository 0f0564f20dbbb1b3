// SPDX-License-Identifier: Apache-2.0
// docs/spec/kinovazed.md has the sentences of the catalogue, and says what the sources cite.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "conformance/kinovazed/suite.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream in{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

std::string page() {
  return std::regex_replace(read(fs::path{source_dir()} / "docs/spec/kinovazed.md"),
                            std::regex{R"(\s+)"}, " ");
}

/// All first groups of the pattern in the text.
std::set<std::string> matches(const std::string& text, const char* pattern) {
  const std::regex regex{pattern};
  std::set<std::string> found;
  for (std::sregex_iterator it{text.begin(), text.end(), regex}, end; it != end; ++it) {
    found.insert((*it)[1]);
  }
  return found;
}

std::set<std::string> documented() {
  return matches(page(), R"(\*\*`(kinovazed\.[a-z0-9.-]+)`\*\* [A-Z0-9])");
}

/// The server's level is left out where it is must.
std::string sentence_of(const Requirement& requirement) {
  const bool is_host = requirement.role == Role::kHost;
  const bool has_level = is_host || requirement.level != Level::kMust;
  const auto level = has_level ? fmt::format("{}; ", to_string(requirement.level)) : "";
  const auto brackets =
      fmt::format("{}{}; {}", level, requirement.source,
                  is_host ? to_string(requirement.role) : to_string(requirement.profiles));
  return fmt::format("**`{}`** {} ({})", requirement.id, requirement.text, brackets);
}

TEST(KinovazedPage, HasTheSentencesOfTheCatalogueAndNoOthers) {
  const auto text = page();
  std::set<std::string> ids;
  for (const auto& chapter : kinovazed::conformance::suite().chapters) {
    for (const auto& requirement : chapter.requirements) {
      ids.emplace(requirement.id);
      EXPECT_NE(text.find(sentence_of(requirement)), std::string::npos) << requirement.id;
    }
  }
  EXPECT_EQ(documented(), ids);
}

TEST(KinovazedPage, DocumentsEveryRequirementThatTheSourcesCite) {
  std::set<std::string> cited;
  for (const auto& entry :
       fs::recursive_directory_iterator{fs::path{source_dir()} / "emulators" / "kinovazed"}) {
    if (!entry.is_regular_file()) continue;
    for (const auto& comment : matches(read(entry.path()), R"((//[^\n]*kinovazed\.[^\n]*))")) {
      cited.merge(
          matches(comment, R"(\b(kinovazed\.(?!(?:hpp|cpp|md|json)\b)[a-z-]+(?:\.[a-z0-9-]+)*))"));
    }
  }
  ASSERT_THAT(cited, testing::Contains("kinovazed.death.mute"));
  std::vector<std::string> missing;
  std::ranges::set_difference(cited, documented(), std::back_inserter(missing));
  EXPECT_THAT(missing, testing::IsEmpty());
}

}  // namespace
}  // namespace armjig
