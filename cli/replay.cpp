// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "cli/checks.hpp"
#include "cli/diff.hpp"
#include "cli/foreign_options.hpp"
#include "cli/outputs.hpp"
#include "cli/replaying.hpp"
#include "cli/target_options.hpp"
#include "harness/report/wording.hpp"

namespace armjig::cli {
namespace {

constexpr auto kReplayHelp =
    "Plays the host's side of a recording against a device and compares what the device says.\n"
    "\n"
    "  armjig replay session.jsonl --target emulated:                  in virtual time\n"
    "  armjig replay session.pcapng --target pty:/tmp/arm --rules rules.toml --allow state,move\n"
    "  armjig replay session.jsonl --target tcp:robot:51717 --rules rules.toml --speed 0.5\n"
    "\n"
    "Each message leaves at its time. The answers are aligned with the recorded ones as by "
    "'armjig\n"
    "diff'; --rules FILE says what may differ, as there. Without it times are compared, too, "
    "which\n"
    "only an emulated device in virtual time can meet.\n"
    "\n"
    "What goes to a device that is not emulated passes the guard. What the recording needs is "
    "asked\n"
    "for before the first byte.\n"
    "\n"
    "Exit codes: 0 equal within the rules, 1 different, 2 usage or not to be played, 3 the "
    "target,\n"
    "or it needs --allow, 4 nothing to compare.";

struct ReplayOptions {
  std::string file;
  TargetOptions target;
  ComparisonOptions comparison;
  double speed = 1;
  ForeignOptions foreign;
};

void print_left_out(const ReplayedRecording& replayed) {
  for (const auto& [what, count] : replayed.left_out) {
    if (what == "overlooked") continue;  // of whoever recorded it
    fmt::print(stderr, "armjig: {} times '{}' could neither be played nor seen there\n", count,
               wording::line(what));
  }
}

Exit replay(Devices devices, const ReplayOptions& options) {
  const auto rules = rules_of(options.comparison.rules);
  if (!rules) return report(rules.error());
  const auto foreign = foreign_how(devices, options.foreign, {});
  if (!foreign) return report(foreign.error());
  const auto rig = parse_target_options(options.target);
  if (!rig) return report(rig.error());
  const auto files = open_outputs({{"--html", options.comparison.html}});
  if (!files) return report(files.error());
  const auto claimed = claim_standard_output(options.comparison.wants_json ? "--json" : "");
  if (!claimed) return report(claimed.error());
  const auto replayed =
      replay_recording(devices, options.file, {*rig, *rules, options.speed, *foreign});
  if (!replayed) return report(replayed.error());
  print_left_out(*replayed);
  return tell(replayed->found, {options.file, options.target.target, replayed->count()},
              options.comparison.wants_json, files->front());
}

}  // namespace

void add_replay(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("replay", kReplayHelp);
  const auto options = std::make_shared<ReplayOptions>();
  command->add_option("FILE", options->file, "a recording, '-' for standard input")->required();
  add_target_options(*command, options->target);
  add_comparison_options(*command, options->comparison);
  command
      ->add_option("--speed", options->speed,
                   "so many times as fast as it was recorded (default: 1)")
      ->type_name("FACTOR")
      ->check(number(0.001, 1000));
  add_foreign_options(*command, options->foreign);
  command->callback([options, devices, &action] {
    action = [options, devices] { return replay(devices, *options); };
  });
}

}  // namespace armjig::cli
