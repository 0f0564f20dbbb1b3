// SPDX-License-Identifier: Apache-2.0
// The counts in the table of README.md are those of the catalogues.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "tests/unit/support/devices.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

std::string counts_of(std::string_view device, std::string_view hosts) {
  std::ptrdiff_t of_hosts = 0;
  std::ptrdiff_t all = 0;
  const auto suite = test::device(device).suite();
  for (const auto& chapter : suite.chapters) {
    all += std::ssize(chapter.requirements);
    of_hosts += std::ranges::count(chapter.requirements, Role::kHost, &Requirement::role);
  }
  return fmt::format(" {}, and {} of {} |", all - of_hosts, of_hosts, hosts);
}

TEST(Readme, CountsTheRequirementsThatThereAre) {
  std::ifstream in{source_dir() + "/README.md"};
  const std::string page{std::istreambuf_iterator<char>{in}, {}};
  const auto row = "| conformance suite, requirements |" + counts_of("parol6", "host programs") +
                   counts_of("morap", "masters") + counts_of("kinovazed", "clients");
  EXPECT_NE(page.find(row), std::string::npos) << row;
}

}  // namespace
}  // namespace armjig
