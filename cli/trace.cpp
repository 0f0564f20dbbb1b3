// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "emulators/replay/kinovazed_matrix.hpp"
#include "emulators/replay/replay.hpp"
#include "harness/capture/trace.hpp"

namespace armjig::cli {
namespace {

constexpr auto kHelp =
    "Replays recordings into fresh emulators in virtual time and compares every byte.\n"
    "\n"
    "  armjig trace verify captures                 all recordings below a folder\n"
    "  armjig trace verify captures/parol6/jog_max_speed_a.jsonl\n"
    "  armjig trace verify captures/kinovazed/state-command-matrix.json\n"
    "\n"
    "Folders are searched for *.jsonl. For each file 'identical' or the first difference is\n"
    "printed; the last line counts them. A table of states and commands (*.json) is verified cell\n"
    "by cell.";

/// How often each verdict was given.
struct Tally {
  int identical = 0;
  int different = 0;
  int unreadable = 0;
};

void verify_table(const std::string& path, Tally& tally) {
  std::ifstream file{path, std::ios::binary};
  const auto verdict =
      kinovazed::verify_matrix(std::string{std::istreambuf_iterator<char>{file}, {}}, path);
  if (!verdict) {
    (void)report(verdict.error());
    ++tally.unreadable;
    return;
  }
  const bool is_identical = verdict->differences.empty();
  ++(is_identical ? tally.identical : tally.different);
  fmt::print("{}: {}, {} cells\n", path, is_identical ? "identical" : "different", verdict->cells);
  for (const auto& [cell, recorded, actual] : verdict->differences) {
    fmt::print("  {}\n    recorded {}\n    emulated {}\n", cell, recorded, actual);
  }
}

void verify_file(const std::string& path, Tally& tally) {
  if (path.ends_with(".json")) return verify_table(path, tally);
  const auto trace = read_trace(path);
  const auto difference = trace ? verify(*trace) : tl::unexpected{trace.error()};
  if (!difference) {
    const bool is_beyond_us = difference.error().code == ErrorCode::kUnknownDevice;
    fmt::print(stderr, "armjig: {}\n", describe(difference.error()));
    if (!is_beyond_us) ++tally.unreadable;
  } else if (!*difference) {
    ++tally.identical;
    fmt::print("{}: identical\n", path);
  } else {
    ++tally.different;
    fmt::print("{}: different\n{}", path, describe(**difference, *trace));
  }
}

Exit verify_all(const std::vector<std::string>& paths) {
  const auto files = find_traces(paths);
  if (!files) {
    (void)report(files.error());
    return Exit::kUsage;
  }
  Tally tally;
  for (const auto& path : *files) verify_file(path, tally);
  const auto verified = tally.identical + tally.different;
  fmt::print("traces: {} identical: {} different: {}\n", verified, tally.identical,
             tally.different);
  if (tally.unreadable > 0) return Exit::kUsage;
  if (verified == 0) return Exit::kNothing;
  return tally.different > 0 ? Exit::kFindings : Exit::kPassed;
}

}  // namespace

void add_trace(CLI::App& app, Action& action) {
  auto* trace = app.add_subcommand("trace", "Recordings of real devices");
  trace->require_subcommand(1);
  auto* verify = trace->add_subcommand("verify", kHelp);
  const auto paths = std::make_shared<std::vector<std::string>>();
  verify->add_option("PATH", *paths, "files or folders")->required();
  verify->callback([paths, &action] { action = [paths] { return verify_all(*paths); }; });
}

}  // namespace armjig::cli
