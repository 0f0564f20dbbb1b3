// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/checks.hpp"
#include "cli/diff.hpp"
#include "cli/foreign_options.hpp"
#include "cli/outputs.hpp"
#include "cli/progress.hpp"
#include "cli/replaying.hpp"
#include "cli/report_files.hpp"
#include "cli/signals.hpp"
#include "cli/target_options.hpp"
#include "cli/terminal.hpp"
#include "cli/verifying.hpp"
#include "conformance/in_parallel.hpp"
#include "conformance/selection.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/version.hpp"
#include "harness/report/report.hpp"
#include "harness/report/wording.hpp"

namespace armjig::cli {
namespace {

namespace fs = std::filesystem;

constexpr auto kCheckHelp =
    "Checks each recording of a corpus, for CI: does the device still say what it said?\n"
    "\n"
    "  armjig captures check corpus                            against emulators, byte by byte\n"
    "  armjig captures check corpus --target pty:/tmp/arm --rules rules.toml --allow state\n"
    "  armjig captures check corpus --junit captures.xml --shard 2/4\n"
    "  armjig captures check corpus --update                   accept what is said now\n"
    "\n"
    "Without --target each recording is replayed into a fresh emulator in virtual time, as by\n"
    "'armjig trace verify', several at a time. With it the host's side is played to that target, "
    "as\n"
    "by 'armjig replay', one after the other unless it is emulated:, and --rules says what may\n"
    "differ. Folders are searched for *.jsonl and *.pcapng.\n"
    "\n"
    "--update first tells what differs, then records those again.\n"
    "\n"
    "Exit codes: 0 all as recorded, or updated; 1 something differs; 2 usage; 3 a recording "
    "cannot\n"
    "be read or played, or the target; 4 nothing was checked.";

struct CheckOptions {
  std::vector<std::string> paths;
  TargetOptions target;
  std::string rules;
  std::string shard = "1/1";
  unsigned jobs = 0;  ///< none: as many as there are processors
  bool updates = false;
  std::string colour = "auto";
  ReportFiles files;
};

/// One recording and what became of it.
struct Checked {
  std::string path;
  ReportRow row;
  bool is_judged = false;
  bool is_of_capture = false;
};

std::string folder_of(const std::string& path) {
  const auto folder = fs::path{path}.parent_path();
  return folder.empty() ? "." : folder.string();
}

std::string first_line_of(std::string_view text) {
  const auto begin = std::min(text.find_first_not_of(' '), text.size());
  return std::string{text.substr(begin, text.find('\n') - begin)};
}

/// What they said is the same, or there is evidence that it is not.
void judge(ReportRow& row, bool is_same, const std::string& evidence) {
  row.verdict = is_same ? Verdict::kPass : Verdict::kFail;
  if (is_same) return;
  row.expected = "what was recorded";
  row.actual = first_line_of(evidence);
  row.evidence = evidence;
}

void fail(ReportRow& row, const Problem& problem) {
  // What is of others lies beside ours.
  const bool is_of_others = problem.code == ErrorCode::kUnknownDevice;
  row.verdict = is_of_others ? Verdict::kSkipped : Verdict::kError;
  row.actual = describe(problem);
}

class Corpus {
 public:
  Corpus(Devices devices, const CheckOptions& options, std::optional<ReplayHow> how)
      : devices_{devices}, options_{options}, how_{std::move(how)} {}

  [[nodiscard]] Checked check(const std::string& path) const {
    const auto begin = std::chrono::steady_clock::now();
    Checked checked{.path = path, .is_judged = true};
    auto& row = checked.row;
    row.name = fmt::format("captures.{}", path);
    row.topic = folder_of(path);
    how_ ? replay(checked) : verify(checked);
    if (row.summary.empty()) row.summary = path;
    row.duration = std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now() - begin);
    return checked;
  }

  /// Writes it again, as the device is now.
  [[nodiscard]] Outcome<void> update(const Checked& checked) const {
    if (how_ || checked.is_of_capture) return record_anew(checked.path);
    if (checked.path.ends_with(".json")) {
      return problem(ErrorCode::kUnsupported, checked.path, "tables are written by hand");
    }
    const auto text = renewed_recording(checked.path, devices_);
    if (!text) return tl::unexpected{text.error()};
    const auto file = open_output("--update", checked.path);
    if (!file) return tl::unexpected{file.error()};
    (*file)->put(*text);
    return {};
  }

 private:
  void verify(Checked& checked) const {
    checked.row.repeat = fmt::format("armjig trace verify {}", checked.path);
    const auto verified = verify_recording(checked.path, devices_);
    if (!verified) return fail(checked.row, verified.error());
    checked.row.summary = verified->title;
    checked.is_of_capture = verified->is_of_capture;
    judge(checked.row, verified->is_identical, verified->what);
  }

  void replay(Checked& checked) const {
    auto& row = checked.row;
    row.repeat = fmt::format("armjig replay {} --target {}{}{}", checked.path,
                             options_.target.target, to_arguments(options_.target),
                             options_.rules.empty() ? "" : " --rules " + options_.rules);
    const auto replayed = replay_recording(devices_, checked.path, *how_);
    if (!replayed) return fail(row, replayed.error());
    if (replayed->count() == 0) {
      row.verdict = Verdict::kInconclusive;
      row.actual = "nothing is in there to be compared";
      return;
    }
    judge(row, replayed->found.empty(), describe(replayed->found, devices_));
  }

  /// Its host's side is played once more, and what passes is recorded.
  [[nodiscard]] Outcome<void> record_anew(const std::string& path) const {
    auto target = options_.target;
    if (target.target.empty()) {
      auto recorded = target_of_recording(path);
      if (!recorded) return tl::unexpected{recorded.error()};
      target.target = *std::move(recorded);
    }
    const fs::path old{path};
    const auto fresh =
        old.parent_path() / fmt::format("{}.new{}", old.stem().string(), old.extension().string());
    target.capture.file = fresh.string();
    if (auto played = play_into(target, path); !played) return played;
    std::error_code error;
    fs::rename(fresh, old, error);
    if (error) return problem(ErrorCode::kCannotWrite, path, error.message());
    return {};
  }

  /// The recording is whole when this returns.
  [[nodiscard]] Outcome<void> play_into(const TargetOptions& target,
                                        const std::string& path) const {
    auto rig = parse_target_options(target);
    if (!rig) return tl::unexpected{rig.error()};
    auto how = how_.value_or(ReplayHow{});
    how.rig = *std::move(rig);
    return replay_recording(devices_, path, how).map([](const auto&) {});
  }

  Devices devices_;
  const CheckOptions& options_;
  std::optional<ReplayHow> how_;  ///< none: emulators, as the recordings say
};

/// Problems: the rules are for --target, or cannot be read; those of the target.
Outcome<std::optional<ReplayHow>> how_of(Devices devices, const CheckOptions& options) {
  if (options.target.target.empty()) {
    const bool is_alone = options.rules.empty() && to_arguments(options.target).empty();
    if (is_alone) return std::nullopt;
    return problem(ErrorCode::kBadValue, "--rules, --allow, --impair",
                   "they are for --target; without it recordings have rules of their own");
  }
  auto rules = rules_asked_for(options.rules);
  if (!rules) return tl::unexpected{rules.error()};
  auto foreign = foreign_how(devices, {}, {});
  if (!foreign) return tl::unexpected{foreign.error()};
  auto rig = parse_target_options(options.target);
  if (!rig) return tl::unexpected{rig.error()};
  return ReplayHow{
      .rig = *std::move(rig), .rules = *std::move(rules), .foreign = *std::move(foreign)};
}

/// Every so-manieth, so that each part has as many of each folder.
std::vector<std::string> part_of(const std::vector<std::string>& files, const Shard& shard) {
  std::vector<std::string> part;
  for (std::size_t i = shard.index - 1; i < files.size(); i += shard.count) {
    part.push_back(files[i]);
  }
  return part;
}

std::vector<Checked> check_all(const Corpus& corpus, const std::vector<std::string>& files,
                               unsigned jobs, const Signals& signals) {
  std::vector<Checked> all(files.size());
  const Progress progress;
  std::atomic<std::size_t> done{0};
  in_parallel(jobs, files.size(), [&](std::size_t i) {
    if (signals.has_come()) return;
    progress.say(fmt::format("{} of {}: {}", ++done, files.size(), files[i]));
    all[i] = corpus.check(files[i]);
  });
  progress.clear();
  std::erase_if(all, [](const Checked& one) { return !one.is_judged; });
  return all;
}

Report report_of(const std::vector<Checked>& all, const CheckOptions& options) {
  Report result;
  result.title = "captures";
  result.facts = {{"against", options.target.target.empty() ? "emulators, as the recordings say"
                                                            : options.target.target},
                  {"shard", options.shard},
                  {"armjig", std::string{kVersion}}};
  for (const auto& one : all) result.rows.push_back(one.row);
  return result;
}

/// Answers whether each was.
bool update_all(const Corpus& corpus, const std::vector<Checked>& all) {
  bool is_done = true;
  for (const auto& one : all) {
    if (one.row.verdict != Verdict::kFail) continue;
    if (const auto updated = corpus.update(one); updated) {
      fmt::print("updated {}\n", one.path);
    } else {
      (void)report(updated.error());
      is_done = false;
    }
  }
  return is_done;
}

Exit check(Devices devices, const CheckOptions& options) {
  const auto shard = parse_shard(options.shard);
  if (!shard) return report(shard.error());
  const auto files = find_traces(options.paths);
  if (!files) return refuse(files.error());
  const auto part = part_of(*files, *shard);
  if (part.empty()) {
    (void)report({ErrorCode::kBadValue, files->empty() ? options.paths.front() : "--shard",
                  fmt::format("nothing to check: {} recordings (*.jsonl, *.pcapng) are in there",
                              files->size())});
    return Exit::kNothing;
  }
  const auto how = how_of(devices, options);
  if (!how) return report(how.error());
  const auto outputs = ReportOutputs::open(options.files);
  if (!outputs) return report(outputs.error());
  const bool is_one_device = *how && !(*how)->rig.target.is_emulated();
  const auto jobs = is_one_device || !options.target.capture.file.empty() ? 1 : options.jobs;
  const Signals signals;
  const Corpus corpus{devices, options, *how};
  const auto all = check_all(corpus, part, jobs, signals);
  const auto result = report_of(all, options);
  fmt::print("{}", to_text(result, style_of(options.colour, stdout)));
  outputs->put(result);
  if (signals.has_come()) return signals.exit();
  const auto exit = static_cast<Exit>(conclusion_of(result));
  if (!options.updates || exit != Exit::kFindings) return exit;
  return update_all(corpus, all) ? Exit::kPassed : Exit::kFindings;
}

}  // namespace

void add_captures(CLI::App& app, Devices devices, Action& action) {
  auto* captures = app.add_subcommand("captures", "Corpora of recordings: check them, for CI");
  captures->require_subcommand(1);
  auto* command = captures->add_subcommand("check", kCheckHelp);
  const auto options = std::make_shared<CheckOptions>();
  options->jobs = std::max(1U, std::thread::hardware_concurrency());
  command->add_option("PATH", options->paths, "files or folders")->required();
  add_target_options(*command, options->target);
  command->add_option("--rules", options->rules, "TOML: what may differ, as for 'armjig diff'")
      ->type_name("FILE");
  command->add_option("--shard", options->shard, "only one part of several, as in 2/4");
  command->add_option("--jobs", options->jobs, "so many at a time (default: one a processor)")
      ->transform(whole(1, 256));
  command->add_flag("--update", options->updates, "record what differs again");
  add_report_files(*command, options->files);
  add_colour_option(*command, options->colour);
  when_chosen(*command, action, [options, devices] { return check(devices, *options); });
}

}  // namespace armjig::cli
