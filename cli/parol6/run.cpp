// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "cli/outputs.hpp"
#include "cli/parol6/commands.hpp"
#include "cli/parol6/script_file.hpp"
#include "cli/signals.hpp"
#include "cli/target_options.hpp"
#include "harness/drive/parol6/activity.hpp"
#include "harness/drive/parol6/drive_loop.hpp"
#include "harness/report/report.hpp"
#include "harness/script/check.hpp"
#include "harness/script/program_run.hpp"
#include "harness/script/run_output.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::cli {
namespace {

using namespace std::chrono_literals;
using parol6::drive::Activity;

constexpr auto kRunHelp =
    "Runs an RBTscript program on an arm and says how well the arm followed.\n"
    "\n"
    "  armjig run pick.rbt --target emulated: --home\n"
    "  armjig run pick.rbt --target pty:/tmp/parol6 --allow move,state,grip\n"
    "\n"
    "The program is checked as a whole before the target is opened, and again from where the arm\n"
    "is before it moves. An arm that was not homed has no angles: --home homes it first, "
    "--unhomed\n"
    "counts from where it was switched on. Ctrl-C makes the arm stand.\n"
    "\n"
    "Exit codes: 0 it ran to its end, 1 it ended early, 2 the program cannot be read or planned, "
    "3\n"
    "the target is silent, gone or forbidden, 130 interrupted.";

struct RunOptions {
  ScriptOptions script;
  PlanningOptions planning;
  TargetOptions target;
  bool must_home = false;
  bool is_unhomed = false;
  bool json = false;
  std::string plots;
};

/// Why nothing more is to be done. Without a text it was said already.
struct Halt {
  Exit exit{};
  std::string text;
};

/// An arm on its rig, for one program.
class ProgramSession {
 public:
  ProgramSession(Rig<StreamPort> rig, const Signals& signals)
      : rig_{std::move(rig)}, loop_{rig_.port(), drive_}, signals_{signals} {}

  /// Waits for a sign of life.
  std::optional<Halt> begin() {
    const auto deadline = rig_.port().now() + 1s;
    while (!drive_.telemetry() && rig_.port().now() < deadline) {
      if (auto halt = cycle()) return halt;
    }
    if (drive_.telemetry()) return std::nullopt;
    return Halt{Exit::kRig, "no telemetry came: is the board there, and switched on?"};
  }

  std::optional<Halt> home() {
    auto homing = parol6::drive::begin_home(drive_);
    if (!homing) return Halt{Exit::kRig, "the emergency stop is pressed"};
    return go_through(**homing, "homing");
  }

  /// Until it has ended, well or not.
  std::optional<Halt> go_through(Activity& activity, std::string_view name) {
    for (;;) {
      if (signals_.has_come()) {
        stop();
        return Halt{signals_.exit(), "interrupted, the arm stands"};
      }
      if (auto halt = cycle()) return halt;
      const auto ending = activity.step(drive_, rig_.port().now(), drive_.take_events());
      if (const auto news = activity.take_news(); !news.empty()) {
        fmt::print(stderr, "{:8.2f} s  {}: {}\n", seconds(), name, news);
      }
      if (!ending) continue;
      fmt::print(stderr, "{:8.2f} s  {}: {}\n", seconds(), name, ending->text);
      return ending->is_success ? std::nullopt : std::optional{Halt{Exit::kFindings, {}}};
    }
  }

  [[nodiscard]] const parol6::TelemetryFrame& telemetry() const { return *drive_.telemetry(); }
  [[nodiscard]] const parol6::drive::DriveStatistics& link() const { return drive_.statistics(); }
  [[nodiscard]] double seconds() {
    return std::chrono::duration<double>{rig_.port().now().time_since_epoch()}.count();
  }

 private:
  std::optional<Halt> cycle() {
    const auto cycled = loop_.cycle();
    if (cycled) return std::nullopt;
    const auto refusal = rig_.last_refusal();
    const bool is_refused = cycled.error().code == ErrorCode::kForbidden && refusal;
    return Halt{Exit::kRig, is_refused ? "stopped by the guard: " + refusal->reason
                                       : std::string{describe(cycled.error().code)}};
  }

  /// Makes the arm stand, for two seconds at most.
  void stop() {
    const auto activity = parol6::drive::begin_stop(drive_);
    const auto deadline = rig_.port().now() + 2s;
    while (rig_.port().now() < deadline && !cycle()) {
      if (activity->step(drive_, rig_.port().now(), drive_.take_events())) return;
    }
  }

  Rig<StreamPort> rig_;
  parol6::drive::Drive drive_;
  parol6::drive::DriveLoop loop_;
  const Signals& signals_;
};

/// What it does, if all of it can be done from there. A long loop repeats itself: its first two
/// passes say it all.
tl::expected<script::Inspection, Halt> check_whole(const script::Program& program,
                                                   Planning planning, const std::string& file) {
  planning.settings.passes = std::min<std::uint64_t>(planning.settings.passes, 2);
  auto checked = script::inspect(program, planning.settings, planning.start);
  // The commander finds out on the way where it ends; nothing of that is sent here.
  const bool is_cut =
      checked.schedule && checked.schedule->stop && program.dialect == script::Dialect::kCommander;
  if (checked.schedule && !is_cut) return checked;
  print_diagnostics(checked.found, file, script::Severity::kWarning);
  return tl::unexpected{Halt{Exit::kUsage, {}}};
}

/// Whether a device that is not emulated would be let do it. What is refused on the way leaves an
/// arm half way.
std::optional<Halt> check_guarded(const script::Program& program, const script::Schedule& schedule,
                                  const Planning& planning, std::uint8_t homed,
                                  const std::string& file) {
  auto refusal = script::check_guarded(program, schedule, planning.start, homed);
  if (!refusal) return std::nullopt;
  print_diagnostics({*std::move(refusal)}, file);
  return Halt{Exit::kRig, {}};
}

/// Whether the user agreed to what it does, before anything is sent.
std::optional<Halt> check_permissions(const script::Program& program, const RigOptions& rig,
                                      bool must_home) {
  if (rig.target.is_emulated()) return std::nullopt;
  auto hazards = hazards_of(program);
  if (must_home) hazards.push_back(Hazard::kHome);
  std::string missing;
  for (const auto hazard : hazards) {
    if (rig.permissions.allow(hazard)) continue;
    missing += fmt::format("{}{}", missing.empty() ? "" : ",", to_string(hazard));
  }
  if (missing.empty()) return std::nullopt;
  return Halt{Exit::kRig, "not allowed: the program needs --allow " + missing};
}

/// Brings the arm to where the program can begin, and plans it from there.
std::optional<Halt> prepare(ProgramSession& session, const script::Program& program,
                            Planning& planning, const RunOptions& options, const Target& target) {
  if (auto halt = session.begin()) return halt;
  if (options.must_home) {
    if (auto halt = session.home()) return halt;
  }
  if (!options.is_unhomed && !is_homed(session.telemetry())) {
    return Halt{Exit::kRig, "the arm is not homed: --home homes it first, --unhomed goes without"};
  }
  planning.start = session.telemetry().position;
  const auto& file = options.script.file;
  const auto checked = check_whole(program, planning, file);
  if (!checked) return checked.error();
  print_diagnostics(checked->found, file, script::Severity::kWarning);
  if (target.is_emulated()) return std::nullopt;
  return check_guarded(program, *checked->schedule, planning, session.telemetry().homed, file);
}

using Plots = std::array<Output, 2>;  // position and error

Outcome<Plots> open_plots(const std::string& folder) {
  if (folder.empty()) return Plots{};
  return open_outputs({{"--plots", folder + "/position.svg"}, {"--plots", folder + "/error.svg"}});
}

/// Prints what came of it.
Exit run_on(ProgramSession& session, const script::Program& program, Planning planning,
            const RunOptions& options, const Target& target, const Plots& files) {
  const auto say = [&](const Halt& halt) {
    if (!halt.text.empty()) {
      fmt::print(stderr, "armjig: {}: {}\n", options.target.target, halt.text);
    }
    return halt.exit;
  };
  if (const auto halt = prepare(session, program, planning, options, target)) return say(*halt);
  script::ProgramRun run{program, planning.settings};
  if (!options.plots.empty()) run.keep_samples(script::kMostFrames / 10);
  const auto halt = session.go_through(run, "run");
  if (options.json) {
    fmt::print("{}", script::to_json(program, run,
                                     {.file = options.script.file,
                                      .target = options.target.target,
                                      .ran_to_end = !halt,
                                      .position = session.telemetry().position,
                                      .link = session.link()}));
  } else {
    fmt::print("{}", to_text(ReportSection{.title = "Tracking error of each move",
                                           .table = script::results_table(program, run)}));
  }
  if (!options.plots.empty()) {
    const auto plots = script::run_plots(run);
    files.front()->put(to_svg(plots.position));
    files.back()->put(to_svg(plots.error));
  }
  return halt ? say(*halt) : Exit::kPassed;
}

Exit run(const Device& device, const RunOptions& options) {
  auto planning = parse_planning(options.planning);
  if (!planning) return report(planning.error());
  if (options.is_unhomed)
    planning->settings.planner.limits = parol6::planning::LimitCheck::kIgnored;
  const auto program = read_script(options.script);
  if (!program) return program.error();
  const auto checked = check_whole(*program, *planning, options.script.file);
  if (!checked) return checked.error().exit;
  const auto how = parse_target_options(options.target);
  if (!how) return report(how.error());
  if (const auto halt = check_permissions(*program, *how, options.must_home)) {
    fmt::print(stderr, "armjig: {}: {}\n", options.target.target, halt->text);
    return halt->exit;
  }
  if (!how->target.is_emulated()) {
    const std::uint8_t homed = options.is_unhomed ? 0 : 0xFF;
    if (const auto halt =
            check_guarded(*program, *checked->schedule, *planning, homed, options.script.file)) {
      return halt->exit;
    }
  }
  const auto claimed = claim_standard_output(options.json ? "--json" : "");
  if (!claimed) return report(claimed.error());
  const auto plots = open_plots(options.plots);
  if (!plots) return report(plots.error());
  const Signals signals;  // first, for a terminal's own handlers end the program without a stop
  auto rig = open_rig<OnStream>(device, *how);
  if (!rig) return report(rig.error());
  ProgramSession session{*std::move(rig), signals};
  return run_on(session, *program, *planning, options, how->target, *plots);
}

}  // namespace

void add_run(CLI::App& app, const Device& device, Action& action) {
  auto* command = app.add_subcommand("run", kRunHelp);
  const auto options = std::make_shared<RunOptions>();
  add_script_options(*command, options->script);
  add_planning_options(*command, options->planning);
  add_target_options(*command, options->target);
  auto* home = command->add_flag("--home", options->must_home, "home the arm first");
  command->add_flag("--unhomed", options->is_unhomed, "run on an arm that was not homed")
      ->excludes(home);
  command->add_flag("--json", options->json, "print armjig.run/1 instead of a table");
  command
      ->add_option("--plots", options->plots,
                   "write position.svg and error.svg of the joints that moved to this folder")
      ->type_name("FOLDER")
      ->check(CLI::ExistingDirectory);
  when_chosen(*command, action, [options, &device] { return run(device, *options); });
}

}  // namespace armjig::cli
