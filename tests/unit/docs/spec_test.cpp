// SPDX-License-Identifier: Apache-2.0
// Requirements that comments and pages name are in the catalogues, and the sections are there.
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

#include "tests/unit/docs/generated.hpp"
#include "tests/unit/support/devices.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig::docs {
namespace {

namespace fs = std::filesystem;

/// Requirements of a device that the text names. Names of files are no names of requirements.
std::set<std::string> cited_in(const std::string& text, const std::string& device) {
  const std::regex regex{
      R"((?:^|[^\w.]))"
      "(" +
      device +
      R"(\.(?!(?:hpp|cpp|md|json|html)\b)[a-z][a-z0-9-]*(?:\.[a-z][a-z0-9-]*)*)\b(?!\.`))"};
  std::set<std::string> found;
  for (std::sregex_iterator it{text.begin(), text.end(), regex}, end; it != end; ++it) {
    found.insert((*it)[1]);
  }
  return found;
}

std::set<std::string> catalogue(const cli::Device& device) {
  std::set<std::string> ids;
  const auto suite = device.suite();
  for (const auto& chapter : suite.chapters) {
    for (const auto& requirement : chapter.requirements) ids.emplace(requirement.id);
  }
  return ids;
}

/// What Wireshark calls the fields of its messages and its settings, which looks like a
/// requirement.
std::set<std::string> filters(const cli::Device& device) {
  if (device.dissection == nullptr) return {};
  std::set<std::string> names{fmt::format("{}.fault", device.name),
                              fmt::format("{}.i2c", device.name)};  // a setting
  for (const auto& kind : device.dissection().messages) {
    for (const auto& field : kind.fields) {
      names.insert(fmt::format("{}.{}", device.name, field.name));
      for (const auto bit : field.bits) {
        names.insert(fmt::format("{}.{}.{}", device.name, field.name, bit));
      }
    }
  }
  return names;
}

/// The comments of all sources that have some.
std::string all_comments() {
  std::string comments;
  for (const auto* room : {"harness", "emulators", "conformance"}) {
    for (const auto& entry : fs::recursive_directory_iterator{fs::path{source_dir()} / room}) {
      const auto extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp") continue;
      std::ifstream in{entry.path()};
      for (std::string line; std::getline(in, line);) {
        const auto begin = line.find("//");
        if (begin != std::string::npos) comments.append(line, begin).append("\n");
      }
    }
  }
  return comments;
}

std::string all_pages() {
  std::string text;
  for (const auto& path : pages()) text += read_page(path);
  return text;
}

/// Those of the first that the second lacks.
std::vector<std::string> without(const std::set<std::string>& all,
                                 const std::set<std::string>& known) {
  std::vector<std::string> rest;
  std::ranges::set_difference(all, known, std::back_inserter(rest));
  return rest;
}

TEST(Requirements, ThatCommentsAndPagesNameAreInTheCatalogues) {
  const auto comments = all_comments();
  const auto text = all_pages();
  for (const auto& device : cli::shipped_devices()) {
    const std::string name{device.name};
    const auto known = catalogue(device);
    EXPECT_THAT(without(cited_in(comments, name), known), testing::IsEmpty()) << name;
    const auto in_pages = cited_in(text, name);
    auto meant = filters(device);
    meant.insert(known.begin(), known.end());
    EXPECT_THAT(without(in_pages, meant), testing::IsEmpty()) << name;
    EXPECT_THAT(without(known, in_pages), testing::IsEmpty()) << name;
  }
  EXPECT_THAT(cited_in(comments, "parol6"), testing::Contains("parol6.home.interrupted"));
  EXPECT_THAT(cited_in(comments, "kinovazed"), testing::Contains("kinovazed.death.mute"));
}

TEST(Parol6Page, HasTheSectionsThatTheSourcesCite) {
  const auto page = read_page("docs/spec/parol6.md");
  for (const auto* title :
       {"\n## Receiving\n", "\n## Stepping\n", "\n## Homing\n", "\n## Gripper\n"}) {
    EXPECT_THAT(page, testing::HasSubstr(title));
  }
}

}  // namespace
}  // namespace armjig::docs
