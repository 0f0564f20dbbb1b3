// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>

#include "cli/outputs.hpp"
#include "cli/parol6/commands.hpp"
#include "cli/parol6/script_file.hpp"
#include "harness/capture/capture.hpp"
#include "harness/capture/trace.hpp"
#include "harness/report/report.hpp"
#include "harness/script/check.hpp"
#include "harness/script/plan_output.hpp"
#include "harness/script/schedule.hpp"

namespace armjig::cli {
namespace {

constexpr auto kPlanHelp =
    "Computes what an RBTscript program sends, without an arm.\n"
    "\n"
    "  armjig plan pick.rbt                              its moves as a table\n"
    "  armjig plan pick.rbt --html plan.html             curves, path, and the arm in motion\n"
    "  armjig plan pick.rbt --csv plan.csv               every set-point\n"
    "  armjig plan pick.rbt --capture plan.pcapng        every byte, as a recording\n"
    "\n"
    "A program that ends with Loop() is planned for one pass, --loops wants more. FILE of --csv "
    "and\n"
    "the like may be '-', which is standard output instead of the table.\n"
    "\n"
    "Exit codes: 0 planned, 1 the plan ends early at a singularity, 2 it cannot be read or "
    "planned.";

struct PlanOptions {
  ScriptOptions script;
  PlanningOptions planning;
  std::string csv;
  std::string json;
  std::string html;
  std::string capture;
};

/// A recording of what is sent on one stream, in the other format if that is wanted.
std::string as_capture(std::string lines, CaptureFormat format) {
  const auto trace = parse_trace("plan", lines);
  if (format == CaptureFormat::kLines || !trace) return lines;
  const auto writer = make_capture_writer(format);
  std::string text;
  (void)writer->begin({trace->header, trace->device}, text);
  const CaptureLink link{trace->device, trace->device, LinkKind::kStream};
  for (const auto& event : trace->events) {
    CaptureRecord record{.time = event.time, .link = &link};
    record.bytes = event.bytes;
    (void)writer->add(record, {}, text);
  }
  return text;
}

Exit plan(const PlanOptions& options) {
  const auto planning = parse_planning(options.planning);
  if (!planning) return report(planning.error());
  const auto format = capture_format_of(options.capture);
  if (!format) return report(format.error());
  const auto files = open_outputs({{"--csv", options.csv},
                                   {"--json", options.json},
                                   {"--html", options.html},
                                   {"--capture", options.capture}});
  if (!files) return report(files.error());
  const auto program = read_script(options.script);
  if (!program) return program.error();
  const auto [schedule, found] = script::inspect(*program, planning->settings, planning->start);
  if (!schedule) {
    print_diagnostics(found, options.script.file);
    return Exit::kUsage;
  }
  const auto& file = options.script.file;
  const auto& [csv, object, html, capture] = *files;
  if (csv) csv->put(to_csv(*program, *schedule));
  if (object) object->put(to_json(*program, *schedule, file));
  if (html) html->put(to_html(to_report(*program, *schedule, file)));
  if (capture) capture->put(as_capture(to_trace(*schedule, file), *format));
  const bool has_table = std::ranges::none_of(
      *files, [](const Output& one) { return one && one->is_standard_output(); });
  if (has_table) {
    fmt::print("{}", to_text(ReportSection{.title = options.script.file,
                                           .table = moves_table(*program, *schedule)}));
  }
  print_diagnostics(found, options.script.file);
  return schedule->stop ? Exit::kFindings : Exit::kPassed;
}

}  // namespace

void add_plan(CLI::App& app, const Device& /*device*/, Action& action) {
  auto* command = app.add_subcommand("plan", kPlanHelp);
  const auto options = std::make_shared<PlanOptions>();
  add_script_options(*command, options->script);
  add_planning_options(*command, options->planning);
  const auto add_output = [command](const char* name, std::string& path, const char* help) {
    command->add_option(name, path, help)->type_name("FILE");
  };
  add_output("--csv", options->csv, "write a line for each frame");
  add_output("--json", options->json, "write it as armjig.plan/1");
  add_output("--html", options->html, "write a page that needs no network");
  add_output("--capture", options->capture,
             "write the bytes to the device to this file: .pcapng, or .jsonl and '-' for a text");
  when_chosen(*command, action, [options] { return plan(*options); });
}

}  // namespace armjig::cli
