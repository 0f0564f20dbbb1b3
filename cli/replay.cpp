// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
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
    "Plays one side of a recording and compares what the other side says.\n"
    "\n"
    "  armjig replay session.jsonl --target emulated:                  in virtual time\n"
    "  armjig replay session.pcapng --target pty:/tmp/arm --rules rules.toml --allow state,move\n"
    "  armjig replay session.jsonl --target tcp:robot:51717 --rules rules.toml --speed 0.5\n"
    "  armjig replay session.jsonl --listen pty:/tmp/arm --rules rules.toml\n"
    "\n"
    "With --target it plays the host. Each message leaves at its time. The answers are aligned "
    "with the recorded ones as by "
    "'armjig\n"
    "diff'; --rules FILE says what may differ, as there. Without it nothing may beside an "
    "emulated\n"
    "device, and beside a real one what 'armjig fuzz' lets pass: times by 100 ms, and more.\n"
    "\n"
    "What goes to a device that is not emulated passes the guard. What the recording needs is "
    "asked\n"
    "for before the first byte.\n"
    "\n"
    "With --listen it plays the device, for a program that is started on that place: it says what "
    "it\n"
    "said when the program has said what was said before. It ends with the recording, on a bus "
    "with\n"
    "Ctrl-C.\n"
    "\n"
    "Exit codes: 0 equal within the rules, 1 different, 2 usage or not to be played, 3 the "
    "target,\n"
    "or it needs --allow, 4 nothing to compare.";

struct ReplayOptions {
  std::string file;
  std::string listen;
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

Outcome<ReplayedRecording> play_host_side(Devices devices, const ReplayOptions& options,
                                          const std::optional<ComparisonRules>& rules,
                                          const ForeignHow& foreign) {
  auto rig = parse_target_options(options.target);
  if (!rig) return tl::unexpected{rig.error()};
  return replay_recording(devices, options.file, {*std::move(rig), rules, options.speed, foreign});
}

Outcome<ReplayedRecording> play_device_side(Devices devices, const ReplayOptions& options,
                                            const std::optional<ComparisonRules>& rules,
                                            const ForeignHow& foreign) {
  return play_recorded_device(devices, options.file,
                              {options.listen, options.comparison.wants_json,
                               rules.value_or(ComparisonRules{}), options.speed, foreign});
}

Exit replay(Devices devices, const ReplayOptions& options) {
  const auto rules = rules_asked_for(options.comparison.rules);
  if (!rules) return report(rules.error());
  const auto foreign = foreign_how(devices, options.foreign, {});
  if (!foreign) return report(foreign.error());
  const auto files = open_outputs({{"--html", options.comparison.html}});
  if (!files) return report(files.error());
  const bool is_device = !options.listen.empty();
  const auto claimed =
      claim_standard_output(options.comparison.wants_json && !is_device ? "--json" : "");
  if (!claimed) return report(claimed.error());
  const auto replayed = is_device ? play_device_side(devices, options, *rules, *foreign)
                                  : play_host_side(devices, options, *rules, *foreign);
  if (!replayed) return report(replayed.error());
  print_left_out(*replayed);
  return tell(replayed->found,
              {options.file, is_device ? options.listen : options.target.target, replayed->count(),
               devices},
              options.comparison.wants_json, files->front());
}

}  // namespace

void add_replay(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("replay", kReplayHelp);
  const auto options = std::make_shared<ReplayOptions>();
  command->add_option("FILE", options->file, "a recording, '-' for standard input")->required();
  add_target_options(*command, options->target);
  auto* listen = command
                     ->add_option("--listen", options->listen,
                                  "play the device there: pty:[PATH], tcp:[HOST:]PORT, "
                                  "rfc2217:[HOST:]PORT, i2c:N")
                     ->type_name("PLACE");
  for (const auto* name : {"--target", "--allow", "--impair", "--capture"}) {
    listen->excludes(command->get_option(name));
  }
  add_comparison_options(*command, options->comparison);
  command
      ->add_option("--speed", options->speed,
                   "so many times as fast as it was recorded (default: 1)")
      ->type_name("FACTOR")
      ->check(number(0.001, 1000));
  add_foreign_options(*command, options->foreign);
  when_chosen(*command, action, [options, devices] { return replay(devices, *options); });
}

}  // namespace armjig::cli
