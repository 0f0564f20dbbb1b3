// SPDX-License-Identifier: Apache-2.0
#include "cli/conformance_mutants.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "conformance/mutation.hpp"

namespace armjig::cli {
namespace {

constexpr auto kHelp =
    "Tries the suite on faulty devices: which of them does it find?\n"
    "\n"
    "Each mutant is an emulated device with one fault. Survivors that nobody could tell from a\n"
    "sound device are listed with the reason; any other one exits with 1, and so does a\n"
    "must-requirement that no mutant breaks.";

struct Options {
  std::string device;
  std::string profile = "firmware";
  MutationOptions run;
  ReportFiles files;
  bool list = false;
};

Exit list_mutants(const MutantsEntry& entry, Profile profile, const std::string& filter) {
  bool has_any = false;
  for (const auto& mutant : mutants_of(entry, profile)) {
    if (mutant.name.find(filter) == std::string::npos) continue;
    has_any = true;
    fmt::print("{:<40} {}{}{}\n", mutant.name, mutant.section,
               mutant.equivalent.empty() ? "" : "; equivalent: ", mutant.equivalent);
  }
  if (has_any) return Exit::kPassed;
  (void)report({ErrorCode::kBadValue, "--filter " + filter,
                "it selects no mutant; --list without it shows all"});
  return Exit::kNothing;
}

Exit run(const Suite& suite, const MutantsEntry& entry, const Options& options) {
  const auto result = run_mutants(suite, entry, options.run);
  if (!result) return report(result.error());
  if (result->fates.empty()) {
    (void)report({ErrorCode::kBadValue, "--filter " + options.run.filter,
                  "it selects no mutant; --list shows them"});
    return Exit::kNothing;
  }
  const auto summary = to_report(*result, suite, options.run);
  for (const auto& row : summary.rows) {
    if (row.verdict != Verdict::kPass) fmt::print("{}", to_text(row));
  }
  for (const auto& section : summary.sections) fmt::print("\n{}", to_text(section));
  fmt::print("\n{}\n", counts_line(summary));
  if (const auto written = write_files(summary, options.files); !written) {
    return report(written.error());
  }
  return static_cast<Exit>(conclusion_of(summary));
}

Exit mutants(Options options) {
  const auto entry = std::ranges::find(armjig::mutants(), options.device, &MutantsEntry::device);
  if (entry == armjig::mutants().end()) {
    std::string names;
    for (const auto& one : armjig::mutants()) names += fmt::format(" {}", one.device);
    return report({ErrorCode::kUnknownDevice, fmt::format("'{}'", options.device),
                   "there are mutants of:" + names});
  }
  options.run.profile = options.profile == "documented" ? Profile::kDocumented : Profile::kFirmware;
  if (options.list) return list_mutants(*entry, options.run.profile, options.run.filter);
  options.run.proves_requirements = options.run.filter.empty();
  return run(*std::ranges::find(suites(), options.device, &Suite::device), *entry, options);
}

}  // namespace

void add_conformance_mutants(CLI::App& conformance, Action& action) {
  auto* command = conformance.add_subcommand("mutants", kHelp);
  const auto options = std::make_shared<Options>();
  options->run.threads = std::max(1U, std::thread::hardware_concurrency());
  command->add_option("DEVICE", options->device, "mutants of what")->required();
  command->add_option("--profile", options->profile, "of the device, and whose expectations")
      ->check(CLI::IsMember({"firmware", "documented"}));
  command->add_option("--filter", options->run.filter, "only mutants with this in their name");
  command->add_option("--threads", options->run.threads, "at most so many at once")
      ->check(CLI::Range(1, 256));
  command->add_flag("--list", options->list, "name the mutants and stop");
  for (const auto& [option, path] :
       {std::pair{"--json", &options->files.json}, std::pair{"--html", &options->files.html},
        std::pair{"--junit", &options->files.junit}, std::pair{"--sarif", &options->files.sarif}}) {
    command->add_option(option, *path, "also write the report to this file")->type_name("FILE");
  }
  command->callback([options, &action] { action = [options] { return mutants(*options); }; });
}

}  // namespace armjig::cli
