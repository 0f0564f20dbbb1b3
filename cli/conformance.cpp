// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <sys/timex.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>

#include "cli/checks.hpp"
#include "cli/choice.hpp"
#include "cli/conformance_mutants.hpp"
#include "cli/device.hpp"
#include "cli/hand_options.hpp"
#include "cli/missed_time.hpp"
#include "cli/progress.hpp"
#include "cli/reference.hpp"
#include "cli/report_files.hpp"
#include "cli/shadowing.hpp"
#include "cli/signals.hpp"
#include "cli/target_options.hpp"
#include "cli/terminal.hpp"
#include "conformance/run.hpp"
#include "conformance/suite.hpp"
#include "harness/capture/told_record.hpp"
#include "harness/core/nearest.hpp"
#include "harness/files/user_file.hpp"
#include "harness/report/diff.hpp"
#include "harness/report/failures.hpp"

namespace armjig::cli {
namespace {

constexpr auto kConformanceHelp =
    "Checks a device against the requirements of its protocol.\n"
    "\n"
    "  armjig conformance DEVICE --target emulated:          the emulator, in virtual time\n"
    "  armjig conformance DEVICE --target pty:/tmp/arm       whatever is behind that terminal\n"
    "  armjig conformance DEVICE --target 'emulated:?fault=NAME'   a faulty one; see 'mutants'\n"
    "  armjig conformance DEVICE --list                      the requirements, one per line\n"
    "  armjig conformance DEVICE --explain REQUIREMENT       what one demands, and why\n"
    "  armjig conformance diff before.json after.json        what a change has done\n"
    "\n"
    "On a device that is not emulated only what cannot move or switch anything is run; --allow\n"
    "adds the rest. Clear the space around the arm before --allow move,home.";

struct ConformanceOptions {
  std::string device;
  TargetOptions target;
  HandOptions hands;
  double required_percent = 100 * RunOptions{}.required_share;
  std::optional<double> most_seconds;
  std::string profile = "firmware";
  std::string tier = "full";
  std::string shard = "1/1";
  std::string waivers;
  std::string explain;
  RunOptions run;
  ShadowOptions shadow;
  ReportFiles files;
  std::string colour;
  bool list = false;
};

/// Names of requirements and of cases.
std::vector<std::string> names_in(const Suite& suite) {
  std::vector<std::string> names;
  for (const auto& chapter : suite.chapters) {
    for (const auto& requirement : chapter.requirements) names.emplace_back(requirement.id);
    for (const auto& one : chapter.cases) names.push_back(name_of(one));
  }
  return names;
}

bool is_listed(const Requirement& requirement, const ConformanceOptions& options) {
  return requirement.id.find(options.run.selection.filter) != std::string_view::npos;
}

Exit list_requirements(const Suite& suite, const ConformanceOptions& options) {
  int listed = 0;
  for (const auto& chapter : suite.chapters) {
    for (const auto& requirement : chapter.requirements) {
      if (!is_listed(requirement, options)) continue;
      ++listed;
      fmt::print("{:<44} {:<6} {:<6} {:<10} {}\n", requirement.id, to_string(requirement.level),
                 to_string(requirement.role), to_string(requirement.profiles), requirement.text);
    }
  }
  if (listed > 0) return Exit::kPassed;
  (void)report({ErrorCode::kBadValue, "--filter " + options.run.selection.filter,
                "it selects no requirement; " +
                    did_you_mean(options.run.selection.filter, names_in(suite), std::identity{}) +
                    "--list without it shows all"});
  return Exit::kNothing;
}

/// The requirement of that name, or of the case of that name.
const Requirement* requirement_named(const Suite& suite, const std::string& name) {
  if (const auto* requirement = find_requirement(suite, name)) return requirement;
  for (const auto& chapter : suite.chapters) {
    const auto one = std::ranges::find(chapter.cases, name, name_of);
    if (one != chapter.cases.end()) return &requirement_of(suite, *one);
  }
  return nullptr;
}

Exit explain(const Suite& suite, const std::string& name) {
  const auto* requirement = requirement_named(suite, name);
  if (requirement == nullptr) {
    return report({ErrorCode::kBadValue, "--explain " + name,
                   "there is no such requirement or case; " +
                       did_you_mean(name, names_in(suite), std::identity{}) +
                       "--list shows the names"});
  }
  fmt::print("{} ({}, {}, profile {})\n  {}\n  source: {}\n", requirement->id,
             to_string(requirement->level), to_string(requirement->role),
             to_string(requirement->profiles), requirement->text, requirement->source);
  if (!requirement->instead.empty()) {
    fmt::print("  the other profile instead: {}\n", requirement->instead);
  }
  if (!requirement->unobservable.empty()) {
    fmt::print("  no case: {}\n", requirement->unobservable);
  }
  for (const auto& chapter : suite.chapters) {
    for (const auto& one : chapter.cases) {
      if (one.requirement != requirement->id) continue;
      fmt::print("  case {}: {} (from: {}; --allow {})\n", name_of(one), one.rule,
                 suite.starts[one.start].name, to_string(one.hazard));
    }
  }
  return Exit::kPassed;
}

std::chrono::year_month_day today() {
  return std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
}

/// Reads what the parser left as words.
Outcome<void> complete(const Suite& suite, ConformanceOptions& options) {
  options.run.profile = options.profile == "documented" ? Profile::kDocumented : Profile::kFirmware;
  options.run.selection.tier = options.tier == "quick" ? Tier::kQuick : Tier::kFull;
  const auto shard = parse_shard(options.shard);
  if (!shard) return tl::unexpected{shard.error()};
  options.run.selection.shard = *shard;
  options.run.required_share = options.required_percent / 100;
  if (options.waivers.empty()) return {};
  auto waivers = read_waivers(options.waivers, suite, today());
  if (!waivers) return tl::unexpected{waivers.error()};
  options.run.waivers = *std::move(waivers);
  return {};
}

/// The command line that does this again, but for the filter.
std::string command_of(const ConformanceOptions& options) {
  auto text =
      fmt::format("armjig conformance {} --target '{}'{}", options.device, options.target.target,
                  to_arguments(options.target) + to_arguments(options.hands));
  if (options.run.profile != Profile::kFirmware)
    text += fmt::format(" --profile {}", options.profile);
  if (options.run.seed != RunOptions{}.seed) text += fmt::format(" --seed {}", options.run.seed);
  return text;
}

/// What was not run has one line, for it may be most of a suite.
std::string line_of(const ReportRow& row, Style style) {
  if (row.verdict != Verdict::kSkipped) return to_text(row, style);
  return fmt::format("SKIPPED   {:<36} {}\n", row.name, row.actual);
}

/// In one line what was not run, and why; nothing if everything was.
void print_skipped(const Report& result) {
  std::map<std::string, int> reasons;
  for (const auto& row : result.rows) {
    if (row.verdict == Verdict::kSkipped) ++reasons[row.actual];
  }
  if (reasons.empty()) return;
  std::string text;
  for (const auto& [reason, count] : reasons) text += fmt::format("; {} {}", count, reason);
  fmt::print("skipped: {}\n", text.substr(2));
}

/// How many wanted to run at once in the last minute; none: nobody knows.
std::optional<double> host_load() {
  std::array<double, 1> load{};
  if (::getloadavg(load.data(), 1) != 1) return std::nullopt;
  return load[0];
}

/// What of this machine bears on moments: how busy it was, and what its clock is kept by.
void add_machine(Report& result) {
  if (const auto load = host_load()) {
    result.facts.emplace_back("host load",
                              fmt::format("{:.2f} in the last minute, on {} processors", *load,
                                          std::thread::hardware_concurrency()));
  }
  timex clock{};
  if (::adjtimex(&clock) < 0) return;
  constexpr double kPartsOfFrequency = 65536;
  const bool is_kept = (clock.status & STA_UNSYNC) == 0;
  result.facts.emplace_back("host clock",
                            fmt::format("corrected by {:+.1f} ppm, {} by a time server",
                                        static_cast<double>(clock.freq) / kPartsOfFrequency,
                                        is_kept ? "kept" : "not kept"));
}

Exit run(const Device& device, const Suite& suite, ConformanceOptions options) {
  auto how = parse_target_options(options.target);
  if (!how) return report(how.error());
  const bool names_profile = how->target.options.contains("profile");
  if (how->target.is_emulated() && !names_profile && options.run.profile != Profile::kFirmware) {
    how->target.options["profile"] = options.profile;
  }
  const auto files = ReportOutputs::open(options.files);
  if (!files) return report(files.error());
  const Signals signals;
  bool is_running = true;
  const auto begun = std::chrono::steady_clock::now();
  options.run.is_time_up = [begun, most = options.most_seconds] {
    return most && std::chrono::steady_clock::now() - begun >= duration_of(*most);
  };
  const MustStop must_stop = [&] {
    const bool is_in_vain = files->is_empty() && is_standard_output_lost();
    return is_running && (signals.has_come() || is_in_vain || options.run.is_time_up());
  };
  how->must_stop = must_stop;
  how->when_left = WhenLeft::kSayNothing;  // cases look at what an arm does without its client
  options.run.must_stop = must_stop;
  auto shadow = LiveShadow::open(device, how->target, options.shadow);
  if (!shadow) return report(shadow.error());
  if (*shadow) {
    how->capture.listener = [&shadow](const CaptureRecord& record) {
      tell(record, (*shadow)->overhearer());
    };
  }
  auto bench = open_bench(device, *how);
  if (!bench) return report(bench.error());
  (*bench)->set_hand(hand_of(options.hands));
  options.run.permissions = how->target.is_emulated() ? Permissions::all() : how->permissions;
  options.run.target = how->target.text;
  options.run.command = command_of(options);
  const bool is_real = !how->target.is_emulated();
  if (is_real || how->impairment) {
    options.run.reference = reference_of(device, *how, options.profile);
  }
  std::optional<MissedTime> missed;
  if (is_real) {  // virtual time stands still when we do
    missed.emplace();
    options.run.missed = [&missed] { return missed->total(); };
    options.run.is_busy = [] { return host_load() > std::thread::hardware_concurrency(); };
  }
  const auto started = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const auto style = style_of(options.colour, stdout);
  const Progress progress;
  options.run.on_wait = [&progress](std::string_view what) { progress.say(what); };
  auto result = run_suite(suite, **bench, options.run, [&](const ReportRow& row) {
    progress.clear();
    fmt::print("{}", line_of(row, style));
    std::fflush(stdout);
  });
  progress.clear();
  is_running = false;
  bench->reset();  // an arm that moves stands before anything else is done
  result.started = started;
  if (is_real) add_machine(result);
  if (options.run.is_time_up()) result.facts.emplace_back("time", "up before every case was run");
  if (signals.has_come()) result.facts.emplace_back("interrupted", "not every case was run");
  if (how->impairment) result.facts.emplace_back("impairment", to_string(*how->impairment));
  fmt::print("{}\n", counts_line(result, style));
  if (result.coverage) fmt::print("judged {}\n", to_text(*result.coverage));
  print_skipped(result);
  if (*shadow) (void)(*shadow)->conclude();
  fmt::print("{}", failures_text(result, style));
  files->put(result);
  return signals.has_come() ? signals.exit() : static_cast<Exit>(conclusion_of(result));
}

Exit conformance(Devices devices, ConformanceOptions options) {
  const auto device = find_device(devices, options.device);
  if (!device) return report(device.error());
  const auto suite = (*device)->suite();
  if (const auto completed = complete(suite, options); !completed) {
    return report(completed.error());
  }
  if (!options.explain.empty()) return explain(suite, options.explain);
  if (options.list) return list_requirements(suite, options);
  if (select(suite, options.run.profile, options.run.selection).empty()) {
    const auto& filter = options.run.selection.filter;
    (void)report({ErrorCode::kBadValue,
                  filter.empty() ? "--shard " + options.shard : "--filter " + filter,
                  "it selects no case of this profile and tier; " +
                      did_you_mean(filter, names_in(suite), std::identity{}) +
                      "--list shows the requirements"});
    return Exit::kNothing;
  }
  return run(**device, suite, std::move(options));
}

Exit compare(const std::string& before, const std::string& after) {
  const auto old_text = read_user_file(before);
  if (!old_text) return report(old_text.error());
  const auto new_text = read_user_file(after);
  if (!new_text) return report(new_text.error());
  const auto diff = compare_reports(*old_text, before, *new_text, after);
  if (!diff) return report(diff.error());
  fmt::print("{}", to_text(*diff));
  return diff->broken.empty() ? Exit::kPassed : Exit::kFindings;
}

void add_diff(CLI::App& conformance, Action& action) {
  struct Files {
    std::string before;
    std::string after;
  };
  auto* command = conformance.add_subcommand(
      "diff", "Compares two reports that --json wrote: fixed, broken, new.");
  const auto files = std::make_shared<Files>();
  command->add_option("BEFORE", files->before, "the report to compare with")->required();
  command->add_option("AFTER", files->after, "the report in question")->required();
  when_chosen(*command, action, [files] { return compare(files->before, files->after); });
}

}  // namespace

void add_conformance(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("conformance", with_example(kConformanceHelp, devices));
  const auto options = std::make_shared<ConformanceOptions>();
  command->add_option("DEVICE", options->device, "which one: " + names_of(devices))->type_name("");
  add_target_options(*command, options->target);
  add_hand_options(*command, options->hands);
  command
      ->add_option("--profile", options->profile,
                   "whose expectations, and which device behind emulated:")
      ->check(one_of({"firmware", "documented"}));
  command->add_option("--filter", options->run.selection.filter, "only what has this in its name");
  command->add_option("--tier", options->tier, "quick leaves out what takes long")
      ->check(one_of({"quick", "full"}));
  command->add_option("--seed", options->run.seed, "for bytes that may be any")
      ->transform(whole(0, std::numeric_limits<std::uint64_t>::max()));
  command->add_option("--repeat", options->run.repeat, "run each case so often")
      ->transform(whole(1, 1'000'000));
  command->add_option("--shard", options->shard, "only one part of several, as in 2/4");
  command->add_flag("--fail-fast", options->run.stops_at_first_failure,
                    "run nothing more once a case has failed");
  command
      ->add_option("--require", options->required_percent,
                   "how many percent of the must requirements within reach have to be judged; "
                   "less is a failure (default: 95)")
      ->type_name("SHARE")
      ->transform(CLI::Validator{[](std::string& text) {
                                   if (text.ends_with('%')) text.pop_back();
                                   return std::string{};
                                 },
                                 ""})
      ->check(number(0, 100));
  command
      ->add_option("--max-time", options->most_seconds,
                   "run no longer than that; what is left is skipped")
      ->type_name("SECONDS")
      ->check(number(0.001, 1e9));
  command->add_option("--waivers", options->waivers, "a file that excuses requirements")
      ->type_name("FILE");
  command->add_option("--explain", options->explain, "say what a requirement demands, and why");
  add_report_files(*command, options->files);
  add_colour_option(*command, options->colour);
  command->add_flag("--list", options->list, "name the requirements and stop");
  add_shadow_options(*command, options->shadow);
  add_diff(*command, action);
  add_conformance_mutants(*command, devices, action);
  command->callback([options, command, devices, &action] {
    if (!command->get_subcommands().empty()) return;
    action = [options, devices] { return conformance(devices, *options); };
  });
}

}  // namespace armjig::cli
