// SPDX-License-Identifier: Apache-2.0
#include "cli/report_files.hpp"

#include <fmt/core.h>

#include <string>

namespace armjig::cli {

std::vector<CLI::Option*> add_report_files(CLI::App& command, ReportFiles& files,
                                           std::string_view except) {
  std::vector<CLI::Option*> added;
  for (const auto& form : report_forms()) {
    if (form.name == except) continue;
    added.push_back(
        command
            .add_option(fmt::format("--{}", form.name), files[std::string{form.name}],
                        fmt::format("also write the report to this file as {}", form.what))
            ->type_name("FILE"));
  }
  return added;
}

Outcome<ReportOutputs> ReportOutputs::open(const ReportFiles& files, std::string_view claimed) {
  if (const auto done = claim_standard_output(claimed); !done) {
    return tl::unexpected{done.error()};
  }
  ReportOutputs outputs;
  for (const auto& form : report_forms()) {
    const auto path = files.find(form.name);
    if (path == files.end() || path->second.empty()) continue;
    auto opened = open_output(fmt::format("--{}", form.name), path->second);
    if (!opened) return tl::unexpected{opened.error()};
    outputs.files_.emplace_back(&form, *std::move(opened));
  }
  return outputs;
}

void ReportOutputs::put(const Report& report) const {
  for (const auto& [form, file] : files_) file->put(form->text_of(report));
}

}  // namespace armjig::cli
