// SPDX-License-Identifier: Apache-2.0
// Tables of fields, requirements and options, and counts, in docs/ and README.md are made from
// data.
#include "tests/unit/docs/generated.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/unit/support/devices.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig::docs {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(GeneratedParts, AreWhatTheDataSay) {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody sets the environment meanwhile
  const bool renews = std::getenv("ARMJIG_RENEW_DOCS") != nullptr;
  for (const auto& path : pages()) {
    const auto page = read_page(path);
    const auto wanted = renewed(page);
    if (wanted.find("??? ") != std::string::npos) {
      ADD_FAILURE() << path << ": " << wanted.substr(wanted.find("??? "), 100);
    } else if (renews && page != wanted) {
      std::ofstream{source_dir() + '/' + path, std::ios::binary} << wanted;
    } else {
      EXPECT_TRUE(page == wanted) << path << " is stale; renew it: scripts/docs";
    }
  }
}

TEST(GeneratedParts, ArePartsOfTheDocumentOfEachDevice) {
  for (const auto& device : cli::shipped_devices()) {
    const auto suite = device.suite();
    const auto page = read_page(std::string{suite.document.path});
    for (const auto& chapter : suite.chapters) {
      EXPECT_THAT(page, HasSubstr("<!-- generated: requirements " + std::string{device.name} +
                                  ", " + std::string{chapter.title} + " -->\n"));
    }
  }
}

TEST(Rooms, HaveAReadme) {
  for (const auto& room : rooms()) {
    if (room.folder.ends_with(".cpp")) continue;  // one of a room that may use more than the others
    EXPECT_NE(read_page(std::string{room.folder} + "/README.md"), "") << room.folder;
  }
}

TEST(GeneratedParts, KeepWhatIsWrittenAroundThem) {
  EXPECT_THAT(
      renewed("a\n<!-- generated: requirements demo, The machine -->\nstale\n<!-- end -->\nb\n"),
      AllOf(StartsWith("a\n<!-- generated: requirements demo, The machine -->\n- **`demo.query`**"),
            Not(HasSubstr("stale")), EndsWith("\n<!-- end -->\nb\n")));
}

TEST(GeneratedParts, SayWhatNobodyCanMake) {
  EXPECT_THAT(renewed("\n<!-- generated: requirements demo, Moods -->\n<!-- end -->\n"),
              HasSubstr("??? nothing is called 'requirements demo, Moods'\n"));
  EXPECT_THAT(renewed("\n<!-- generated: options nobody -->\n<!-- end -->\n"), HasSubstr("??? "));
  EXPECT_THAT(renewed("a\n<!-- generated: counts -->\n"), HasSubstr("??? 'counts' has no end\n"));
}

}  // namespace
}  // namespace armjig::docs
