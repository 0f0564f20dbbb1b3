// SPDX-License-Identifier: Apache-2.0
// docs/cli.md has the options of emulated devices as their tables have them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include "emulators/kinovazed/options.hpp"
#include "emulators/morap/options.hpp"
#include "emulators/parol6/options.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

/// The page with the rows between the device's marks.
std::string with_rows(const std::string& page, const std::string& device,
                      std::span<const OptionRow> rows) {
  const auto mark = "<!-- options " + device + " -->\n";
  const auto found = page.find(mark);
  EXPECT_NE(found, std::string::npos) << mark;
  if (found == std::string::npos) return page;
  const auto begin = found + mark.size();
  return page.substr(0, begin) + to_markdown(rows) + page.substr(page.find("<!-- end -->", begin));
}

TEST(CommandLinePage, HasTheOptionsOfEmulatedDevices) {
  const auto path = source_dir() + "/docs/cli.md";
  std::ifstream in{path, std::ios::binary};
  const std::string page{std::istreambuf_iterator<char>{in}, {}};
  auto wanted = with_rows(page, "parol6", parol6::emulation::options());
  wanted = with_rows(wanted, "kinovazed", kinovazed::emulation::options());
  wanted = with_rows(wanted, "morap", morap::emulation::options());
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody sets the environment meanwhile
  if (std::getenv("ARMJIG_RENEW_DOCS") != nullptr) {
    std::ofstream{path, std::ios::binary} << wanted;
  } else {
    EXPECT_TRUE(page == wanted) << "docs/cli.md is stale; renew it: ARMJIG_RENEW_DOCS=1 unit_tests "
                                   "--gtest_filter='CommandLinePage.*'";
  }
}

}  // namespace
}  // namespace armjig
