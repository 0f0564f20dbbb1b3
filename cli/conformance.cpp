// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/target_options.hpp"
#include "conformance/suite.hpp"

namespace armjig::cli {
namespace {

constexpr auto kHelp =
    "Checks a device against the requirements of its protocol.\n"
    "\n"
    "  armjig conformance parol6 --target emulated:          the emulator, in virtual time\n"
    "  armjig conformance parol6 --target pty:/tmp/parol6    whatever is behind that terminal\n"
    "  armjig conformance parol6 --target 'emulated:?fault=swap-bytes:speed.j1'   a faulty board\n"
    "  armjig conformance parol6 --list                      the cases, one a line\n"
    "  armjig conformance parol6 --explain parol6.frame.burst\n"
    "\n"
    "Nothing in it moves a joint. With --allow state it also switches the two outputs; it leaves\n"
    "them off.";

struct Options {
  std::string device;
  TargetOptions target;
  Selection selection;
  std::string explain;
  ReportFiles files;
  bool list = false;
};

Exit list_cases(const Suite& suite, const Selection& selection) {
  int listed = 0;
  for (const auto& one : suite.cases) {
    if (!is_selected(selection, one)) continue;
    ++listed;
    fmt::print("{:<36} {}\n", one.id, one.rule);
  }
  return listed > 0 ? Exit::kPassed : Exit::kNothing;
}

Exit explain(const Suite& suite, const std::string& name) {
  bool is_known = false;
  for (const auto& requirement : suite.requirements) {
    const bool is_meant = name.starts_with(requirement.id);
    if (!is_meant) continue;
    is_known = true;
    fmt::print("{} ({})\n  {}\n  source: {}\n", requirement.id, to_string(requirement.level),
               requirement.text, requirement.source);
    for (const auto& one : suite.cases) {
      if (one.requirement == requirement.id) fmt::print("  case {}: {}\n", one.id, one.rule);
    }
  }
  if (is_known) return Exit::kPassed;
  return report({ErrorCode::kBadValue, "--explain " + name, "--list shows the names"});
}

Exit run(const Suite& suite, const Options& options) {
  const auto how = parse_target_options(options.target);
  if (!how) return report(how.error());
  auto rig = open_rig(suite.device, *how);
  if (!rig) return report(rig.error());
  auto selection = options.selection;
  selection.permissions = how->permissions;
  selection.arguments = to_arguments(options.target);
  auto result = run_suite(suite, rig->port(), how->target, selection, [](const ReportRow& row) {
    fmt::print("{}", to_text(row));
    std::fflush(stdout);
  });
  if (how->impairment) result.facts.emplace_back("impairment", to_string(*how->impairment));
  fmt::print("{}\n", counts_line(result));
  if (const auto written = write_files(result, options.files); !written) {
    return report(written.error());
  }
  return static_cast<Exit>(conclusion_of(result));
}

Exit conformance(const Options& options) {
  const auto& suite = *std::ranges::find(suites(), options.device, &Suite::device);
  if (!options.explain.empty()) return explain(suite, options.explain);
  const bool selects_nothing = std::ranges::none_of(
      suite.cases, [&](const Case& one) { return is_selected(options.selection, one); });
  if (selects_nothing) {
    (void)report({ErrorCode::kBadValue, "--filter " + options.selection.filter,
                  "it selects no case; --list shows them"});
    return Exit::kNothing;
  }
  return options.list ? list_cases(suite, options.selection) : run(suite, options);
}

std::vector<std::string> device_names() {
  std::vector<std::string> names;
  for (const auto& suite : suites()) names.emplace_back(suite.device);
  return names;
}

}  // namespace

void add_conformance(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("conformance", kHelp);
  const auto options = std::make_shared<Options>();
  command->add_option("DEVICE", options->device, "which suite")
      ->required()
      ->check(CLI::IsMember(device_names()));
  add_target_options(*command, options->target);
  command->add_option("--filter", options->selection.filter, "only cases with this in their name");
  command->add_option("--explain", options->explain, "say what a requirement demands, and why");
  command->add_option("--json", options->files.json, "also write the report to this file as JSON");
  command->add_option("--html", options->files.html,
                      "also write the report to this file as a page");
  command->add_flag("--list", options->list, "name the cases and stop");
  command->callback([options, &action] { action = [options] { return conformance(*options); }; });
}

}  // namespace armjig::cli
