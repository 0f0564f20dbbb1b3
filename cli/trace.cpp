// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/device.hpp"
#include "cli/trace_files.hpp"
#include "cli/trace_random.hpp"
#include "emulators/replay/on_port.hpp"
#include "emulators/replay/replay.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/nesting.hpp"
#include "harness/files/user_file.hpp"
#include "harness/report/wording.hpp"
#include "harness/rig/target.hpp"

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
    "Folders are searched for *.jsonl. For each file 'identical' or the first difference is\n"
    "printed; the last line counts them. A table of states and commands (*.json) is verified cell\n"
    "by cell.";

/// How often each verdict was given.
struct Tally {
  int identical = 0;
  int different = 0;
  int unreadable = 0;
};

/// The device of a table; nullptr if none here has tables.
const Device* device_of_table(const std::string& text, Devices devices) {
  const auto table = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  const auto name = table.is_object() ? table.value("device", nlohmann::json{}) : nlohmann::json{};
  for (const auto& device : devices) {
    const bool is_named = !name.is_string() || name.get<std::string>() == device.name;
    if (is_named && device.replay.verify_table != nullptr) return &device;
  }
  return nullptr;
}

Outcome<TableVerdict> verdict_of_table(const std::string& path, Devices devices) {
  const auto text = read_user_file(path);
  if (!text) return tl::unexpected{text.error()};
  if (is_too_deep(*text)) return problem(ErrorCode::kMalformed, path, std::string{kTooDeep});
  const auto* const device = device_of_table(*text, devices);
  if (device != nullptr) return device->replay.verify_table(*text, path);
  return problem(ErrorCode::kUnknownDevice, path,
                 "no emulator here is verified by tables of that device");
}

void verify_table(const std::string& path, Devices devices, Tally& tally) {
  const auto verdict = verdict_of_table(path, devices);
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

/// Whether `--capture` made it.
bool is_of_capture(const Trace& trace) {
  const auto header = nlohmann::json::parse(trace.header, nullptr, /*allow_exceptions=*/false);
  return header.is_object() && header.value("title", nlohmann::json{}) == "capture";
}

/// By a device like the one that was recorded, on a port in memory.
Outcome<std::optional<TraceDifference>> verify_capture(const Trace& trace, const Device& device) {
  const auto text = emulated_target_of(trace);
  if (!text) return tl::unexpected{text.error()};
  const auto target = parse_target(*text);
  if (!target) return tl::unexpected{target.error()};
  return std::visit(
      [&](const auto& kind) -> Outcome<std::optional<TraceDifference>> {
        const auto port = wiring_of(device, kind).open_emulated(*target);
        if (!port) return tl::unexpected{port.error()};
        const auto replayed = replay_on(**port, trace);
        if (!replayed) return tl::unexpected{replayed.error()};
        if (replayed->recorded.empty()) {
          return problem(ErrorCode::kMalformed, trace.path, "no answer is in there to be verified");
        }
        return first_difference(replayed->recorded, replayed->actual);
      },
      device.port);
}

void verify_file(const std::string& path, Devices devices, Tally& tally) {
  if (path.ends_with(".json")) return verify_table(path, devices, tally);
  const auto trace = read_trace(path);
  if (!trace) {
    (void)report(trace.error());
    ++tally.unreadable;
    return;
  }
  const auto* const device = find_recorded_device(devices, trace->device);
  if (device == nullptr) {
    fmt::print(stderr, "armjig: {}: no emulator replays '{}' here\n", wording::line(path),
               wording::line(trace->device));
    return;
  }
  const auto difference =
      is_of_capture(*trace) ? verify_capture(*trace, *device) : verify(*trace, device->replay);
  if (!difference) {
    (void)report(difference.error());
    ++tally.unreadable;
  } else if (!*difference) {
    ++tally.identical;
    fmt::print("{}: identical\n", path);
  } else {
    ++tally.different;
    fmt::print("{}: different\n{}", path, describe(**difference, *trace, device->make_dissector));
  }
}

Exit verify_all(const std::vector<std::string>& paths, Devices devices) {
  const auto files = find_traces(paths);
  if (!files) {
    (void)report(files.error());
    return Exit::kUsage;
  }
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
  verify->callback([paths, devices, &action] {
    action = [paths, devices] { return verify_all(*paths, devices); };
  });
  add_trace_files(*trace, devices, action);
  add_trace_random(*trace, devices, action);
}

}  // namespace armjig::cli
