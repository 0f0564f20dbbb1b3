// SPDX-License-Identifier: Apache-2.0
// Writes pages for report_page_test.py: report_page_sample FOLDER
#include <cstdio>
#include <string>

#include "harness/report/report.hpp"
#include "tests/unit/report/sample_report.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: report_page_sample FOLDER\n", stderr);
    return 2;
  }
  const std::string folder = argv[1];
  for (const auto& [name, report] : {std::pair{"drive", armjig::test::drive_report()},
                                     std::pair{"nasty", armjig::test::nasty_report()}}) {
    const auto stem = folder + '/' + name;
    const auto written = write_files(report, {{"json", stem + ".json"},
                                              {"html", stem + ".html"},
                                              {"junit", stem + ".xml"},
                                              {"sarif", stem + ".sarif"}});
    if (!written) {
      std::fprintf(stderr, "%s\n", describe(written.error()).c_str());
      return 3;
    }
  }
  return 0;
}
