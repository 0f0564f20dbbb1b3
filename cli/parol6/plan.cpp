// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <memory>
#include <string>

#include "cli/parol6/commands.hpp"
#include "cli/parol6/script_file.hpp"
#include "harness/report/report.hpp"
#include "harness/script/check.hpp"
#include "harness/script/plan_output.hpp"
#include "harness/script/schedule.hpp"

namespace armjig::cli {
namespace {

constexpr auto kHelp =
    "Computes what an RBTscript program sends, without an arm.\n"
    "\n"
    "  armjig plan pick.rbt                              its moves as a table\n"
    "  armjig plan pick.rbt --html plan.html             curves, path, and the arm in motion\n"
    "  armjig plan pick.rbt --csv plan.csv               every set-point\n"
    "  armjig plan pick.rbt --trace plan.jsonl           every byte, as a recording\n"
    "\n"
    "A program that ends with Loop() is planned for one pass, --loops wants more. FILE of --csv "
    "and\n"
    "the like may be '-', which is standard output instead of the table.\n"
    "\n"
    "Exit codes: 0 planned, 1 the plan ends early at a singularity, 2 it cannot be read or "
    "planned.";

struct Options {
  ScriptOptions script;
  PlanningOptions planning;
  std::string csv;
  std::string json;
  std::string html;
  std::string trace;
};

Outcome<void> put(const std::string& path, const std::string& content) {
  if (path != "-") return write_file(path, content);
  fmt::print("{}", content);
  return {};
}

/// Every form that was asked for.
Outcome<void> write_all(const Options& options, const script::Program& program,
                        const script::Schedule& schedule) {
  const auto& file = options.script.file;
  Outcome<void> done;
  if (!options.csv.empty()) done = put(options.csv, to_csv(program, schedule));
  if (done && !options.json.empty()) done = put(options.json, to_json(program, schedule, file));
  if (done && !options.html.empty()) {
    done = put(options.html, to_html(to_report(program, schedule, file)));
  }
  if (done && !options.trace.empty()) done = put(options.trace, to_trace(schedule, file));
  return done;
}

bool wants_stdout(const Options& options) {
  return options.csv == "-" || options.json == "-" || options.html == "-" || options.trace == "-";
}

Exit plan(const Options& options) {
  const auto planning = parse_planning(options.planning);
  if (!planning) return report(planning.error());
  const auto program = read_script(options.script);
  if (!program) return program.error();
  const auto [schedule, found] = script::inspect(*program, planning->settings, planning->start);
  if (!schedule) {
    print_diagnostics(found, options.script.file);
    return Exit::kUsage;
  }
  if (const auto done = write_all(options, *program, *schedule); !done) return report(done.error());
  if (!wants_stdout(options)) {
    fmt::print("{}", to_text(ReportSection{.title = options.script.file,
                                           .table = moves_table(*program, *schedule)}));
  }
  print_diagnostics(found, options.script.file);
  return schedule->stop ? Exit::kFindings : Exit::kPassed;
}

}  // namespace

void add_plan(CLI::App& app, const Device& /*device*/, Action& action) {
  auto* command = app.add_subcommand("plan", kHelp);
  const auto options = std::make_shared<Options>();
  add_script_options(*command, options->script);
  add_planning_options(*command, options->planning);
  const auto add_output = [command](const char* name, std::string& path, const char* help) {
    command->add_option(name, path, help)->type_name("FILE");
  };
  add_output("--csv", options->csv, "write a line for each frame");
  add_output("--json", options->json, "write it as armjig.plan/1");
  add_output("--html", options->html, "write a page that needs no network");
  add_output("--trace", options->trace, "write the bytes to the device as golden-trace/1");
  command->callback([options, &action] { action = [options] { return plan(*options); }; });
}

}  // namespace armjig::cli
