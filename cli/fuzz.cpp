// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/diff.hpp"
#include "cli/fuzz_learn.hpp"
#include "cli/fuzz_material.hpp"
#include "cli/fuzz_suite.hpp"
#include "cli/hand_options.hpp"
#include "cli/progress.hpp"
#include "cli/report_files.hpp"
#include "cli/signals.hpp"
#include "cli/target_options.hpp"
#include "cli/terminal.hpp"
#include "conformance/selection.hpp"
#include "emulators/campaign/campaign.hpp"
#include "emulators/campaign/campaign_report.hpp"
#include "emulators/campaign/cause.hpp"
#include "emulators/campaign/folder.hpp"
#include "harness/report/wording.hpp"

namespace armjig::cli {
namespace {

using namespace campaign;

constexpr auto kFuzzHelp =
    "Looks for defects that no test was written for: plays what programs say and what none says "
    "to\n"
    "a device, and compares each answer with that of an emulated device.\n"
    "\n"
    "  armjig fuzz DEVICE --target 'emulated:?fault=NAME' --max-time 60\n"
    "  armjig fuzz DEVICE --target pty:/tmp/arm --allow all --restart ./restart --out found\n"
    "  armjig fuzz DEVICE --target emulated: --known fuzz/known/DEVICE-defects.toml --cases 1000\n"
    "  armjig fuzz DEVICE --merge board1 board2 --out all\n"
    "  armjig fuzz DEVICE --target emulated: --learn --draw machine.svg\n"
    "\n"
    "The model is the device of the document, or, with --known, the one that the file describes.\n"
    "Each finding is made as short as it can be, and a recording that 'armjig replay' plays. On a\n"
    "device that is not emulated only what --allow names is sent. Clear the space around the arm\n"
    "before --allow move,home. With --learn no cases are played: the machine that the device "
    "shows\n"
    "is learned by asking, and compared with the documented one.\n"
    "\n"
    "Exit codes: 0 nothing new was found, 1 findings, 2 usage, 3 the target, 4 no case was "
    "played,\n"
    "130 interrupted; what was found so far is reported and kept.";

struct FuzzOptions {
  std::string device;
  TargetOptions target;
  HandOptions hands;
  std::string model;
  std::string known;
  std::string rules;
  std::string out;
  std::string shard = "1/1";
  std::vector<std::string> merge;
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> cases;
  std::optional<double> most_seconds;
  std::optional<double> length;
  bool stops_at_first = false;
  LearnSettings learning;
  ReportFiles files;
  std::string colour;
};

constexpr Duration kLongestLive = std::chrono::seconds{8};
constexpr auto kShrinkingEmulated = std::chrono::seconds{30};
constexpr auto kShrinkingLive = std::chrono::minutes{5};
constexpr std::size_t kCasesBetweenResetsLive = 8;
/// All that a run is told, read.
struct FuzzRun {
  const Device& device;
  RigOptions how;
  FuzzOptions options;
  Known known;
  RigOptions model;
  CampaignFacts facts;
};

bool has_profile(const Device& device) {
  return std::ranges::any_of(device.options(),
                             [](const OptionRow& row) { return row.name == "profile"; });
}

/// The options of the model: those of an emulated target without its faults, then what is known.
Outcome<Target> model_of(const Device& device, const FuzzOptions& options, const Target& target,
                         const Known& known) {
  if (!options.model.empty()) return parse_target(options.model);
  auto with = target.is_emulated() ? target.options : DeviceOptions{};
  const auto said = known.model.empty() && has_profile(device) && options.known.empty()
                        ? std::string{"profile=documented"}
                        : known.model;
  if (!said.empty()) {
    const auto parsed = parse_target("emulated:?" + said);
    if (!parsed) return parsed;
    for (const auto& [name, value] : parsed->options) with[name] = value;
  }
  return sound_target(std::move(with));
}

Outcome<Share> share_of(const std::string& text) {
  return parse_shard(text).map([](const Shard& shard) {
    return Share{static_cast<std::uint32_t>(shard.index), static_cast<std::uint32_t>(shard.count)};
  });
}

Outcome<FuzzRun> read_run(const Device& device, const FuzzOptions& options) {
  auto how = parse_target_options(options.target);
  if (!how) return tl::unexpected{how.error()};
  auto known = options.known.empty() ? Outcome<Known>{Known{}} : Known::read(options.known);
  if (!known) return tl::unexpected{known.error()};
  const auto share = share_of(options.shard);
  if (!share) return tl::unexpected{share.error()};
  auto model = model_of(device, options, how->target, *known);
  if (!model) return tl::unexpected{model.error()};
  RigOptions model_rig;
  model_rig.target = *std::move(model);
  if (!model_rig.target.is_emulated()) {
    return problem(ErrorCode::kBadValue, "--model " + options.model,
                   "a model has to be emulated: only virtual time can be led");
  }
  CampaignFacts facts{{std::string{device.name}, model_rig.target.text,
                       fmt::format("armjig fuzz --seed {}", options.seed)},
                      port_name_of(device),
                      options.seed,
                      *share};
  return FuzzRun{device, *std::move(how), options, *std::move(known), std::move(model_rig), facts};
}

/// What is done at a finding to see it again.
std::string repeat_of(const FuzzRun& run, const std::optional<Folder>& folder,
                      const campaign::Finding& finding) {
  if (!folder) {
    const auto known = run.options.known.empty() ? "" : " --known " + run.options.known;
    const auto model =
        run.options.model.empty() ? "" : fmt::format(" --model '{}'", run.options.model);
    return fmt::format("armjig fuzz {} --target '{}'{}{}{}{} --seed {} --cases {}", run.device.name,
                       run.options.target.target, to_arguments(run.options.target),
                       to_arguments(run.options.hands), model, known, run.options.seed,
                       finding.case_number + 1);
  }
  return fmt::format("armjig replay {} --target '{}'{}", folder->path_of(finding),
                     run.options.target.target, to_arguments(run.options.target));
}

/// Writes what is found as it is found, and says how far it is.
class Account {
 public:
  Account(const std::optional<Folder>& folder, std::size_t causes)
      : folder_{folder}, causes_{causes} {}

  [[nodiscard]] CampaignListener listener() {
    return {.on_case =
                [this](const CampaignState& state) {
                  progress_.say(progress_line(state));
                  if (!folder_ || std::chrono::steady_clock::now() < next_) return;
                  note(folder_->keep(state));
                  next_ = std::chrono::steady_clock::now() + std::chrono::seconds{5};
                },
            .on_finding =
                [this](const CampaignState& state) {
                  const auto& finding = state.findings.back();
                  const bool is_further = state.causes == std::exchange(causes_, state.causes);
                  progress_.clear();
                  fmt::print("{} {}\n",
                             is_further              ? "  also "
                             : finding.known.empty() ? "FINDING"
                                                     : "KNOWN  ",
                             wording::line(finding.sentence));
                  std::fflush(stdout);
                  if (folder_) note(folder_->keep(finding));
                },
            .on_worthy =
                [this](const Script& script, std::uint64_t number) {
                  if (folder_) note(folder_->keep_worthy(script, number));
                }};
  }
  void finish(const CampaignState& state) {
    progress_.clear();
    if (folder_) note(folder_->keep(state));
  }
  [[nodiscard]] const Outcome<void>& written() const noexcept { return written_; }

 private:
  void note(Outcome<void> done) {
    if (written_ && !done) written_ = std::move(done);
  }

  const std::optional<Folder>& folder_;
  std::size_t causes_;
  Progress progress_;
  std::chrono::steady_clock::time_point next_{};
  Outcome<void> written_;
};

Exit conclude(const FuzzOptions& options, const Report& report, const ReportOutputs& files) {
  const auto style = style_of(options.colour, stdout);
  fmt::print("{}", to_text(report, style));
  files.put(report);
  return static_cast<Exit>(conclusion_of(report));
}

CampaignOptions campaign_options(const FuzzRun& run, const CampaignState& state,
                                 ComparisonRules rules, MustStop must_stop) {
  const bool is_live = !run.how.target.is_emulated();
  CampaignOptions options{
      .seed = run.options.seed,
      .share = run.facts.share,
      .first_case = state.cases,
      .most_cases = run.options.cases.value_or(std::numeric_limits<std::int64_t>::max()),
      .judging = {run.device.make_dissector, std::move(rules), kHorizon},
      .known = run.known,
      .most_shrinking = kShrinkingEmulated,
      .stops_at_first = run.options.stops_at_first,
      .when_survey = WhenSurvey::kInTurn,
      .must_stop = std::move(must_stop)};
  if (is_live) {
    options.cases_between_resets = kCasesBetweenResetsLive;
    options.confirmations = 3;
    options.doubts = 3;
    options.most_shrinking = kShrinkingLive;
    options.when_survey = WhenSurvey::kFirst;
    options.judging.horizon += options.judging.rules.time_tolerance;
    options.judging.told_interval = run.device.fuzz.told_interval;
    options.excuses.add({}, "connection", "time");  // of whoever carries the end of it
  }
  return options;
}

Exit campaign_on(const FuzzRun& run, const std::optional<Folder>& folder, CampaignState state) {
  const auto files = ReportOutputs::open(run.options.files);
  if (!files) return report(files.error());
  auto rules = rules_beside(run.device, run.how.target, run.options.rules);
  if (!rules) return report(rules.error());
  const Signals signals;
  const auto begun = std::chrono::steady_clock::now();
  const MustStop must_stop = [&signals, begun, most = run.options.most_seconds] {
    return signals.has_come() ||
           (most && std::chrono::steady_clock::now() - begun >= duration_of(*most));
  };
  auto how = run.how;
  how.when_left = WhenLeft::kSayNothing;  // what an arm does then is to be seen
  how.must_stop = [&signals] { return signals.has_come(); };
  const auto is_live = !how.target.is_emulated();
  const auto length = run.options.length ? duration_of(*run.options.length)
                      : is_live          ? kLongestLive
                                         : kLongestEmulated;
  auto material = material_of(run.device, how, run.model, length);
  if (!material) return report(material.error());
  material->rules = *rules;
  material->written = scripts_of_suite(run.device, run.model, material->has_hands, length);
  if (run.options.length) material->longest_tour = length;
  const auto hand = hand_of(run.options.hands);
  auto stage =
      stage_of(run.device, how, run.device, run.model, hand, kHorizon + 2 * rules->time_tolerance);
  const auto options = campaign_options(run, state, *std::move(rules), must_stop);
  Account account{folder, causes_of(state.findings).size()};
  const auto done = run_campaign(*stage, *material, options, state, account.listener());
  account.finish(state);
  const bool was_stopped = !done && signals.has_come();
  auto result =
      to_report(std::string{run.device.name}, state,
                [&](const campaign::Finding& finding) { return repeat_of(run, folder, finding); });
  result.facts = {{"target", how.target.text},
                  {"model", run.model.target.text},
                  {"seed", fmt::format("{}", run.options.seed)},
                  {"shard", run.options.shard},
                  {"cases", fmt::format("{} to {}", options.first_case, state.cases)}};
  if (!run.options.known.empty()) result.facts.emplace_back("known", run.options.known);
  if (is_live)
    result.started = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  if (!done && !was_stopped) {
    result.rows.push_back(row_of_end(std::string{run.device.name}, done.error()));
  }
  if (signals.has_come()) result.facts.emplace_back("interrupted", "not every case was played");
  auto exit = conclude(run.options, result, *files);
  if (!done && !was_stopped) {
    const auto of_problem = report(done.error());
    if (exit != Exit::kFindings) exit = of_problem;
  }
  if (!account.written()) exit = report(account.written().error());
  return signals.has_come() ? signals.exit() : exit;
}

/// What several campaigns found, in one folder and one report.
Exit merge(const Device& device, const FuzzOptions& options) {
  const auto files = ReportOutputs::open(options.files);
  if (!files) return report(files.error());
  const CampaignFacts facts{{std::string{device.name}, "emulated:", "armjig fuzz --merge"},
                            port_name_of(device),
                            options.seed,
                            {}};
  std::vector<CampaignState> states;
  std::map<std::string, std::string> paths;
  for (const auto& path : options.merge) {
    auto state =
        Folder::open(path, facts).and_then([](const Folder& one) { return one.load_any(); });
    if (!state) return report(state.error());
    for (const auto& finding : state->findings) {
      paths.emplace(name_of(finding), fmt::format("{}/findings/{}.jsonl", path, name_of(finding)));
    }
    states.push_back(*std::move(state));
  }
  const auto all = merged(std::move(states));
  if (!options.out.empty()) {
    if (const auto written = copy_into(options.out, facts, all, options.merge); !written) {
      return report(written.error());
    }
  }
  auto result = to_report(std::string{device.name}, all, [&](const campaign::Finding& finding) {
    return fmt::format("armjig replay {} --target TARGET", paths[name_of(finding)]);
  });
  result.facts = {{"merged", fmt::format("{} campaigns", options.merge.size())}};
  return conclude(options, result, *files);
}

/// Nothing but `--restart` starts a device again: whoever sets inputs may not know that one.
Hand hand_for(const HandOptions& options) {
  auto hand = hand_of(options);
  if (options.restart.empty()) {
    hand.has = [has = std::move(hand.has)](std::string_view input) {
      return input != "restart" && has(input);
    };
  }
  return hand;
}

Exit learn_machines(const Device& device, const FuzzOptions& options) {
  const auto how = parse_target_options(options.target);
  if (!how) return report(how.error());
  const auto repeat = fmt::format("armjig fuzz {} --target '{}'{}{} --learn --seed {}", device.name,
                                  options.target.target, to_arguments(options.target),
                                  to_arguments(options.hands), options.seed);
  const auto hand = hand_for(options.hands);
  return learn(
      {device, *how, hand, options.learning, options.seed, options.files, options.colour, repeat});
}

Exit fuzz(Devices devices, const FuzzOptions& options) {
  const auto device = find_device(devices, options.device);
  if (!device) return report(device.error());
  if (options.learning.is_wanted) return learn_machines(**device, options);
  if (!options.merge.empty()) return merge(**device, options);
  const auto run = read_run(**device, options);
  if (!run) return report(run.error());
  std::optional<Folder> folder;
  CampaignState state;
  if (!options.out.empty()) {
    auto opened = Folder::open(options.out, run->facts);
    if (!opened) return report(opened.error());
    auto loaded = opened->load();
    if (!loaded) return report(loaded.error());
    folder = *std::move(opened);
    state = *std::move(loaded);
  }
  return campaign_on(*run, folder, std::move(state));
}

}  // namespace

void add_fuzz(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("fuzz", with_example(kFuzzHelp, devices));
  const auto options = std::make_shared<FuzzOptions>();
  add_device_argument(*command, options->device, devices);
  add_target_options(*command, options->target);
  command
      ->add_option("--restart", options->hands.restart,
                   "starts the program of a device that is not emulated again")
      ->type_name("COMMAND");
  auto* const hand =
      command
          ->add_option(
              "--hand", options->hands.hand,
              "sets an input of a device that is not emulated, with --learn: called with its "
              "name and value")
          ->type_name("COMMAND");
  auto* const model =
      command
          ->add_option(
              "--model", options->model,
              "what answers are compared with (default: emulated: as the document promises)")
          ->type_name("TARGET");
  auto* const known =
      command
          ->add_option("--known", options->known,
                       "a file of known defects, which are no findings; it says what the model is")
          ->type_name("FILE");
  auto* const rules =
      command
          ->add_option("--rules", options->rules,
                       "what may differ from the model, as for replay (default: of a live device "
                       "what depends on its time)")
          ->type_name("FILE");
  command->add_option("--seed", options->seed, "of what is drawn; 1 if not given")
      ->transform(whole(0, std::numeric_limits<std::uint64_t>::max()));
  auto* const cases = command->add_option("--cases", options->cases, "play no more than so many");
  cases->transform(whole(1, std::numeric_limits<std::int64_t>::max()));
  auto* const most_time =
      command->add_option("--max-time", options->most_seconds, "play no longer than that")
          ->type_name("SECONDS")
          ->check(number(0.001, 1e9));
  auto* const length =
      command
          ->add_option("--length", options->length,
                       "the longest case, in the device's time; most have an eighth of that "
                       "(default: 60 emulated, 8 live)")
          ->type_name("SECONDS")
          ->check(number(0.001, 3600));
  auto* const out = command
                        ->add_option("--out", options->out,
                                     "a folder for what is found; a campaign that is in it goes on")
                        ->type_name("FOLDER");
  auto* const shard =
      command->add_option("--shard", options->shard, "only one part of several, as in 2/4");
  auto* const merge =
      command
          ->add_option("--merge", options->merge,
                       "play nothing, but put together what campaigns left in these folders")
          ->type_name("FOLDER");
  auto* const first =
      command->add_flag("--fail-fast", options->stops_at_first, "end at the first finding");
  add_learn_options(*command, options->learning,
                    {model, known, rules, cases, most_time, length, out, shard, merge, first});
  hand->needs("--learn");
  add_report_files(*command, options->files);
  add_colour_option(*command, options->colour);
  when_chosen(*command, action, [options, devices] { return fuzz(devices, *options); });
}

}  // namespace armjig::cli
