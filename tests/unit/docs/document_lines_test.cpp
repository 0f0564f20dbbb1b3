// SPDX-License-Identifier: Apache-2.0
// Reports point to the lines of docs/spec in which the requirements stand.
#include <gtest/gtest.h>

#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/devices/devices.hpp"
#include "conformance/requirement.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

std::vector<std::string> lines_of(std::string_view document) {
  std::ifstream in{source_dir() + '/' + std::string{document}};
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

void expect_places(std::span<const Requirement> requirements, const Document& document) {
  const auto lines = lines_of(document.path);
  for (const auto& requirement : requirements) {
    const auto row = row_about(requirement, document);
    EXPECT_EQ(row.document, document.path);
    ASSERT_TRUE(row.line >= 1 && row.line <= lines.size()) << requirement.id;
    EXPECT_TRUE(lines[row.line - 1].starts_with("- **`" + std::string{requirement.id} + "`** "))
        << document.path << ':' << row.line << ' ' << requirement.id;
  }
}

TEST(DocumentLines, HoldTheNameOfEachRequirementOfEachDevice) {
  for (const auto& device : cli::shipped_devices()) {
    const auto suite = device.suite();
    for (const auto& chapter : suite.chapters) expect_places(chapter.requirements, suite.document);
    if (!device.program_check) continue;
    expect_places(device.program_check->requirements(), device.program_check->document);
  }
}

TEST(DocumentLines, OfARequirementThatIsNotInTheDocumentAreUnknown) {
  const Requirement requirement{.id = "parol6.not-there"};
  const auto row = row_about(requirement, shipped_document("docs/spec/parol6.md"));
  EXPECT_EQ(row.document, "docs/spec/parol6.md");
  EXPECT_EQ(row.line, 0);
}

}  // namespace
}  // namespace armjig
