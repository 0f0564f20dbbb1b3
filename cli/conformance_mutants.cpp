// SPDX-License-Identifier: Apache-2.0
#include "cli/conformance_mutants.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <thread>

#include "cli/checks.hpp"
#include "cli/choice.hpp"
#include "cli/device.hpp"
#include "cli/report_files.hpp"
#include "cli/signals.hpp"
#include "cli/terminal.hpp"
#include "conformance/mutation.hpp"

namespace armjig::cli {
namespace {

constexpr auto kMutantsHelp =
    "Tries the suite on faulty devices: which of them does it find?\n"
    "\n"
    "Each mutant is an emulated device with one fault. Survivors that nobody could tell from a\n"
    "sound device are listed with the reason; any other one exits with 1, and so does a\n"
    "must-requirement that no mutant breaks.";

struct MutantsOptions {
  std::string device;
  std::string profile = "firmware";
  MutationOptions run;
  ReportFiles files;
  std::string colour;
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

Exit run(const Device& device, const MutantsEntry& entry, MutantsOptions options) {
  const auto files = ReportOutputs::open(options.files);
  if (!files) return report(files.error());
  const auto suite = device.suite();
  const auto open = [&device](const RigOptions& how) { return open_bench(device, how); };
  const Signals signals;
  options.run.must_stop = [&signals, &files] {
    return signals.has_come() || (files->is_empty() && is_standard_output_lost());
  };
  const auto result = run_mutants(suite, entry, open, options.run);
  if (!result) return report(result.error());
  if (result->fates.empty()) {
    (void)report({ErrorCode::kBadValue, "--filter " + options.run.filter,
                  "it selects no mutant; --list shows them"});
    return Exit::kNothing;
  }
  auto summary = to_report(*result, suite, options.run);
  const auto style = style_of(options.colour, stdout);
  if (const auto skipped = summary.count(Verdict::kSkipped); skipped > 0) {
    fmt::print("interrupted: {} mutants were not tried\n", skipped);
  }
  for (const auto& row : summary.rows) {
    if (row.verdict != Verdict::kPass && row.verdict != Verdict::kSkipped) {
      fmt::print("{}", to_text(row, style));
    }
  }
  for (const auto& section : summary.sections) fmt::print("\n{}", to_text(section, style));
  fmt::print("\n{}\n", counts_line(summary, style));
  files->put(summary);
  return signals.has_come() ? signals.exit() : static_cast<Exit>(conclusion_of(summary));
}

Exit mutants(Devices devices, MutantsOptions options) {
  const auto device = find_device(devices, options.device);
  if (!device) return report(device.error());
  const auto entry = (*device)->mutants();
  options.run.profile = options.profile == "documented" ? Profile::kDocumented : Profile::kFirmware;
  if (options.list) return list_mutants(entry, options.run.profile, options.run.filter);
  options.run.proves_requirements = options.run.filter.empty();
  return run(**device, entry, std::move(options));
}

}  // namespace

void add_conformance_mutants(CLI::App& conformance, Devices devices, Action& action) {
  auto* command = conformance.add_subcommand("mutants", kMutantsHelp);
  const auto options = std::make_shared<MutantsOptions>();
  options->run.threads = std::max(1U, std::thread::hardware_concurrency());
  add_device_argument(*command, options->device, devices);
  command->add_option("--profile", options->profile, "of the device, and whose expectations")
      ->check(one_of({"firmware", "documented"}));
  command->add_option("--filter", options->run.filter, "only mutants with this in their name");
  command->add_option("--threads", options->run.threads, "at most so many at once")
      ->transform(whole(1, 256));
  command->add_flag("--list", options->list, "name the mutants and stop");
  add_report_files(*command, options->files);
  add_colour_option(*command, options->colour);
  when_chosen(*command, action, [options, devices] { return mutants(devices, *options); });
}

}  // namespace armjig::cli
