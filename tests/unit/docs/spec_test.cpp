// SPDX-License-Identifier: Apache-2.0
// docs/spec/parol6.md says what the sources cite, and its tables are those of the field lists.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "conformance/parol6/suite.hpp"
#include "harness/wire/parol6/fields.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream in{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

std::string parol6_page() { return read(fs::path{source_dir()} / "docs/spec/parol6.md"); }

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
  return matches(parol6_page(), R"(\*\*`(parol6\.[a-z0-9.-]+)`\*\*\s+[A-Z][^(]+\()");
}

/// Requirements that comments name. Names of files are no names of requirements.
std::set<std::string> cited() {
  std::set<std::string> ids;
  for (const auto* room : {"harness", "emulators", "conformance"}) {
    for (const auto& entry : fs::recursive_directory_iterator{fs::path{source_dir()} / room}) {
      const auto extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp") continue;
      const auto text = read(entry.path());
      for (const auto& comment : matches(text, R"((//[^\n]*parol6\.[^\n]*))")) {
        ids.merge(
            matches(comment, R"(\b(parol6\.(?!(?:hpp|cpp|md|json)\b)[a-z-]+(?:\.[a-z-]+)*))"));
      }
    }
  }
  return ids;
}

TEST(Parol6Page, DocumentsEveryRequirementThatTheSourcesCite) {
  const auto ids = cited();
  ASSERT_THAT(ids, testing::Contains("parol6.home.interrupted"));
  std::vector<std::string> missing;
  std::ranges::set_difference(ids, documented(), std::back_inserter(missing));
  EXPECT_THAT(missing, testing::IsEmpty());
}

/// Words with single blanks between them.
std::string flowing(const std::string& text) {
  return std::regex_replace(text, std::regex{R"(\s+)"}, " ");
}

TEST(Parol6Page, HasTheSentencesOfTheCatalogueAndNoOthers) {
  const auto page = flowing(parol6_page());
  std::set<std::string> ids;
  for (const auto& chapter : parol6::conformance::suite().chapters) {
    for (const auto& requirement : chapter.requirements) {
      ids.emplace(requirement.id);
      EXPECT_NE(page.find(fmt::format("**`{}`** {} (", requirement.id, requirement.text)),
                std::string::npos)
          << requirement.id;
    }
  }
  EXPECT_EQ(documented(), ids);
}

TEST(Parol6Page, HasTheSectionsThatTheSourcesCite) {
  const auto page = parol6_page();
  for (const auto* title :
       {"\n## Receiving\n", "\n## Stepping\n", "\n## Homing\n", "\n## Gripper\n"}) {
    EXPECT_THAT(page, testing::HasSubstr(title));
  }
}

/// The rows of the first table below a heading, as `offset width name`.
std::vector<std::string> rows_below(const std::string& heading) {
  const auto page = parol6_page();
  const auto begin = page.find("\n### " + heading + "\n");
  if (begin == std::string::npos) return {};
  const auto section = page.substr(begin, page.find("\n### ", begin + 1) - begin);
  const std::regex row{R"(\n\| (\d+) \| (\d+) \| `([^`]+)` \|)"};
  std::vector<std::string> rows;
  for (std::sregex_iterator it{section.begin(), section.end(), row}, end; it != end; ++it) {
    rows.push_back(fmt::format("{} {} {}", (*it)[1].str(), (*it)[2].str(), (*it)[3].str()));
  }
  return rows;
}

std::vector<std::string> rows_of(std::span<const Field> fields) {
  std::vector<std::string> rows;
  for (const auto& field : fields) {
    rows.push_back(fmt::format("{} {} {}", field.offset, field.width, field.name));
  }
  return rows;
}

TEST(Parol6Page, HasTheFieldsOfTheCommandFrame) {
  EXPECT_EQ(rows_below("Command frame"), rows_of(parol6::command_fields()));
}

TEST(Parol6Page, HasTheFieldsOfTheTelemetryFrame) {
  EXPECT_EQ(rows_below("Telemetry frame"), rows_of(parol6::telemetry_fields()));
}

}  // namespace
}  // namespace armjig
