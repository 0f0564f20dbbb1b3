// SPDX-License-Identifier: Apache-2.0
#include "cli/report_files.hpp"

#include <fmt/core.h>

#include <string>

namespace armjig::cli {

std::array<CLI::Option*, 4> add_report_files(CLI::App& command, ReportFiles& files) {
  const auto add = [&command](const char* option, std::string& path, const char* what) {
    return command
        .add_option(option, path, fmt::format("also write the report to this file as {}", what))
        ->type_name("FILE");
  };
  return {add("--json", files.json, "JSON"), add("--html", files.html, "a page"),
          add("--junit", files.junit, "JUnit XML"), add("--sarif", files.sarif, "SARIF")};
}

}  // namespace armjig::cli
