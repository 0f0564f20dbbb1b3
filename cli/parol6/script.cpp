// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "cli/parol6/commands.hpp"
#include "cli/parol6/script_file.hpp"
#include "harness/script/check.hpp"
#include "harness/script/format.hpp"
#include "harness/script/parser.hpp"

namespace armjig::cli {
namespace {

constexpr auto kCheckHelp =
    "Says what is wrong with a program before it runs: errors, limits, singularities, arguments\n"
    "that do nothing, a gripper that is not waited for; and how long it takes.\n"
    "\n"
    "  armjig script check pick.rbt\n"
    "  armjig script check pick.rbt --dialect commander    as the vendor's PC program takes it\n"
    "\n"
    "Exit codes: 0 nothing is wrong, 1 errors or warnings, 2 it cannot be read.";

constexpr auto kFormatHelp =
    "Prints a program in one style; comments stay.\n"
    "\n"
    "  armjig script format pick.rbt > pretty.rbt\n"
    "\n"
    "Exit codes: 0 done, 2 it cannot be read.";

struct CheckOptions {
  ScriptOptions script;
  PlanningOptions planning;
};

Exit refuse_script(const std::vector<script::Diagnostic>& errors, const std::string& file) {
  for (const auto& error : errors) fmt::print("{}\n", describe(error, file));
  return Exit::kUsage;
}

Exit check(const CheckOptions& options) {
  const auto& file = options.script.file;
  const auto planning = parse_planning(options.planning);
  if (!planning) return report(planning.error());
  const auto text = read_script_text(options.script);
  if (!text) return report(text.error());
  const auto program = script::parse(*text, dialect_of(options.script));
  if (!program) return refuse_script(with_advice(program.error(), *text, options.script), file);
  const auto found = script::inspect(*program, planning->settings, planning->start).found;
  for (const auto& diagnostic : found) fmt::print("{}\n", describe(diagnostic, file));
  const bool is_clean = std::ranges::all_of(
      found, [](const auto& one) { return one.severity == script::Severity::kNote; });
  return is_clean ? Exit::kPassed : Exit::kFindings;
}

Exit format(const ScriptOptions& options) {
  const auto text = read_script_text(options);
  if (!text) return report(text.error());
  const auto formatted = script::format(*text, dialect_of(options));
  if (!formatted) {
    print_diagnostics(with_advice(formatted.error(), *text, options), options.file);
    return Exit::kUsage;
  }
  fmt::print("{}", *formatted);
  return Exit::kPassed;
}

}  // namespace

void add_script(CLI::App& app, const Device& /*device*/, Action& action) {
  auto* command = app.add_subcommand("script", "Checks and formats RBTscript programs.");
  command->require_subcommand(1);

  auto* check_command = command->add_subcommand("check", kCheckHelp);
  const auto check_options = std::make_shared<CheckOptions>();
  add_script_options(*check_command, check_options->script);
  add_planning_options(*check_command, check_options->planning);
  when_chosen(*check_command, action, [check_options] { return check(*check_options); });

  auto* format_command = command->add_subcommand("format", kFormatHelp);
  const auto format_options = std::make_shared<ScriptOptions>();
  add_script_options(*format_command, *format_options);
  when_chosen(*format_command, action, [format_options] { return format(*format_options); });
}

}  // namespace armjig::cli
