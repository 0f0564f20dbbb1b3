// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/trace_files.hpp"
#include "cli/trace_random.hpp"
#include "cli/trace_what_if.hpp"
#include "cli/verifying.hpp"
#include "harness/capture/trace.hpp"

namespace armjig::cli {
namespace {

constexpr auto kTraceHelp =
    "Replays recordings into fresh emulators in virtual time and compares every byte.\n"
    "\n"
    "  armjig trace verify captures                 all recordings below a folder\n"
    "  armjig trace verify session.jsonl            one of them\n"
    "  armjig trace verify matrix.json              a table of states and commands\n"
    "  armjig trace verify capture.pcapng           what --capture wrote of an emulated device\n"
    "\n"
    "Folders are searched for *.jsonl and *.pcapng. For each file 'identical' or the first "
    "difference is\n"
    "printed; the last line counts them. A table of states and commands (*.json) is verified cell\n"
    "by cell.";

/// How often each verdict was given.
struct Tally {
  int identical = 0;
  int different = 0;
  int unreadable = 0;
};

void verify_file(const std::string& path, Devices devices, Tally& tally) {
  const auto verified = verify_recording(path, devices);
  if (!verified) {
    (void)report(verified.error());
    // What is of others lies beside ours.
    if (verified.error().code != ErrorCode::kUnknownDevice) ++tally.unreadable;
    return;
  }
  ++(verified->is_identical ? tally.identical : tally.different);
  const auto cells = verified->cells ? fmt::format(", {} cells", *verified->cells) : "";
  fmt::print("{}: {}{}\n{}", path, verified->is_identical ? "identical" : "different", cells,
             verified->what);
}

Exit verify_all(const std::vector<std::string>& paths, Devices devices) {
  const auto files = find_traces(paths);
  if (!files) return refuse(files.error());
  Tally tally;
  for (const auto& path : *files) verify_file(path, devices, tally);
  const auto verified = tally.identical + tally.different;
  fmt::print("traces: {} identical: {} different: {}\n", verified, tally.identical,
             tally.different);
  if (tally.unreadable > 0) return Exit::kUsage;
  if (verified == 0) return Exit::kNothing;
  return tally.different > 0 ? Exit::kFindings : Exit::kPassed;
}

}  // namespace

void add_trace(CLI::App& app, Devices devices, Action& action) {
  auto* trace = app.add_subcommand("trace", "Recordings: verify, look at, convert, cut, merge");
  trace->require_subcommand(1);
  auto* verify = trace->add_subcommand("verify", kTraceHelp);
  const auto paths = std::make_shared<std::vector<std::string>>();
  verify->add_option("PATH", *paths, "files or folders")->required();
  when_chosen(*verify, action, [paths, devices] { return verify_all(*paths, devices); });
  add_trace_files(*trace, devices, action);
  add_trace_random(*trace, devices, action);
  add_trace_what_if(*trace, devices, action);
}

}  // namespace armjig::cli
