// SPDX-License-Identifier: Apache-2.0
#include "cli/fuzz_learn.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/fuzz_material.hpp"
#include "cli/outputs.hpp"
#include "cli/progress.hpp"
#include "cli/report_files.hpp"
#include "cli/signals.hpp"
#include "cli/terminal.hpp"
#include "emulators/campaign/questions.hpp"
#include "harness/mealy/drawing.hpp"

namespace armjig::cli {
namespace {

using campaign::Learnable;

/// One machine, learned and compared.
struct Lesson {
  const Learnable& machine;
  mealy::Learned learned;
  std::optional<mealy::Machine> documented;
  mealy::Drawing drawing;
};

Outcome<std::vector<const Learnable*>> chosen_machines(const Device& device,
                                                       const std::string& name) {
  if (device.fuzz.machines.empty()) {
    return problem(ErrorCode::kUnsupported, std::string{device.name},
                   "its entry has no alphabet to learn over (FuzzEntry::machines, "
                   "docs/adding-a-device.md)");
  }
  std::vector<const Learnable*> machines;
  std::vector<std::string_view> names;
  for (const auto& machine : device.fuzz.machines) {
    names.push_back(machine.name);
    if (name.empty() || machine.name == name) machines.push_back(&machine);
  }
  if (machines.empty()) {
    return problem(ErrorCode::kBadValue, "--machine " + name,
                   fmt::format("{} has {}", device.name, fmt::join(names, ", ")));
  }
  return machines;
}

/// What names of rows may have.
std::string as_row_name(std::string text) {
  for (auto& letter : text) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '.';
    if (!is_plain) letter = '-';
  }
  return text;
}

std::string row_name_of(const Device& device, const Lesson& lesson, const std::string& rest) {
  return as_row_name(fmt::format("{}.learn.{}{}{}", device.name, lesson.machine.name,
                                 rest.empty() ? "" : ".", rest));
}

std::string cost_of(const mealy::Asked& asked) {
  return fmt::format(
      "{} letters in {} words, {} words to try it{}", asked.letters, asked.words, asked.tests,
      asked.unsteady == 0
          ? ""
          : fmt::format(", {} that were answered otherwise at least once", asked.unsteady));
}

ReportRow lesson_row(const Device& device, const Lesson& lesson) {
  const auto& machine = lesson.drawing.machine;
  const auto& contradiction = lesson.learned.contradiction;
  ReportRow row;
  row.verdict = lesson.learned.is_settled ? Verdict::kPass
                : contradiction.empty()   ? Verdict::kInconclusive
                                          : Verdict::kFlaky;
  row.name = row_name_of(device, lesson, "");
  row.evidence = cost_of(lesson.learned.asked);
  row.source = lesson.machine.source;
  const auto& comparison = lesson.drawing.comparison;
  const auto* const judgement = !lesson.documented              ? "; no document tells which"
                                : !lesson.learned.is_settled    ? " so far"
                                : comparison.deviations.empty() ? ", as documented"
                                                                : "";
  row.summary = fmt::format("The machine {} has {} states over {} letters{}.", lesson.machine.name,
                            machine.states.size(), machine.letters.size(), judgement);
  if (!contradiction.empty()) {
    row.expected = "the same answers each time";
    row.actual = contradiction;
  } else if (!lesson.learned.is_settled) {
    row.actual =
        "it was not tried to the end: the letters were used up (--most-letters), or it "
        "was interrupted";
  }
  return row;
}

ReportRow lesson_row(const Device& device, const Lesson& lesson,
                     const mealy::Deviation& deviation) {
  ReportRow row;
  row.verdict = Verdict::kFail;
  row.name = row_name_of(device, lesson, deviation.name);
  row.summary = deviation.sentence;
  row.source = lesson.machine.source;
  row.expected = deviation.documented;
  row.actual = deviation.learned;
  row.evidence = "shown by: " + lesson.drawing.machine.words_of(deviation.shown_by);
  return row;
}

/// Steps of a state that say the same and lead to the same one are one row.
ReportSection lesson_section(const Lesson& lesson) {
  const auto& machine = lesson.drawing.machine;
  ReportSection section{.title = fmt::format("machine {}", lesson.machine.name)};
  section.table.columns = {"state", "letters", "answer", "leads to"};
  for (const auto& state : machine.states) {
    std::map<std::pair<std::size_t, std::string>, std::vector<std::string>> steps;
    for (std::size_t i = 0; i < machine.letters.size(); ++i) {
      steps[{state.steps[i].to, state.steps[i].said}].push_back(machine.letters[i]);
    }
    for (const auto& [step, letters] : steps) {
      section.table.rows.push_back({state.name, fmt::format("{}", fmt::join(letters, ", ")),
                                    mealy::said_in_words(step.second),
                                    machine.states[step.first].name});
    }
  }
  return section;
}

class Learning {
 public:
  Learning(const LearnRun& run, const Signals& signals) : run_{run}, signals_{signals} {
    how_ = run.how;
    how_.when_left = WhenLeft::kSayNothing;
    how_.must_stop = [&signals] { return signals.has_come(); };
  }

  [[nodiscard]] Outcome<Lesson> learn(const Learnable& machine) {
    const auto letters = campaign::letters_of(machine);
    const auto where = fmt::format("machine {} of {}", machine.name, run_.device.name);
    std::optional<mealy::Machine> documented;
    if (!machine.documented.empty()) {
      auto built = mealy::documented(machine.documented, letters, where);
      if (!built) return tl::unexpected{built.error()};
      documented = *std::move(built);
    }
    const auto stage = stage_alone(run_.device, how_, run_.hand, run_.settings.speed);
    const auto quiet = run_.settings.quiet ? duration_of(*run_.settings.quiet) : Duration{};
    campaign::Questions questions{*stage, machine, run_.device.make_dissector, quiet};
    auto learned = mealy::learn(questions, letters, options_for(machine));
    progress_.clear();
    if (!learned) return tl::unexpected{learned.error()};
    used_ += learned->asked.letters;
    Lesson lesson{machine, *std::move(learned), std::move(documented), {}};
    draw(lesson);
    return lesson;
  }
  [[nodiscard]] std::size_t used() const noexcept { return used_; }

 private:
  mealy::LearnOptions options_for(const Learnable& machine) {
    return {
        .seed = run_.seed,
        .most_letters = run_.settings.letters - std::min<std::size_t>(used_, run_.settings.letters),
        .must_stop = [this] { return signals_.has_come(); },
        .on_asked =
            [this, name = machine.name](const mealy::Asked& asked, std::size_t states) {
              progress_.say(fmt::format("machine {}: {} states; {}", name, states, cost_of(asked)));
            }};
  }

  void draw(Lesson& lesson) const {
    auto& drawing = lesson.drawing;
    drawing.title = fmt::format("{}: {}", run_.device.name, lesson.machine.name);
    drawing.machine = lesson.learned.machine;
    if (!lesson.documented || !lesson.learned.is_settled) return;
    drawing.comparison = mealy::compare(drawing.machine, *lesson.documented);
    drawing.machine =
        mealy::named(std::move(drawing.machine), *lesson.documented, drawing.comparison);
  }

  const LearnRun& run_;
  const Signals& signals_;
  RigOptions how_;
  Progress progress_;
  std::size_t used_ = 0;
};

Report lessons_report(const LearnRun& run, const std::vector<Lesson>& lessons, std::size_t used) {
  Report report;
  report.title = fmt::format("machines of {}", run.device.name);
  report.facts = {{"target", run.how.target.text},
                  {"seed", fmt::format("{}", run.seed)},
                  {"letters", fmt::format("{}", used)}};
  for (const auto& lesson : lessons) {
    report.rows.push_back(lesson_row(run.device, lesson));
    for (const auto& deviation : lesson.drawing.comparison.deviations) {
      report.rows.push_back(lesson_row(run.device, lesson, deviation));
    }
    report.sections.push_back(lesson_section(lesson));
  }
  for (auto& row : report.rows) row.repeat = run.repeat;
  if (!run.how.target.is_emulated()) {
    report.started = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  }
  return report;
}

}  // namespace

void add_learn_options(CLI::App& command, LearnSettings& settings,
                       const std::vector<CLI::Option*>& except) {
  auto* const learns = command.add_flag(
      "--learn", settings.is_wanted,
      "play no cases, but learn the machine that the device shows, and say where it is not as "
      "documented");
  for (auto* const option : except) learns->excludes(option);
  const auto add = [&](const std::string& name, auto& value, const std::string& what) {
    return command.add_option(name, value, what)->needs(learns);
  };
  add("--machine", settings.machine, "only that one of the machines that the entry has")
      ->type_name("NAME");
  add("--most-letters", settings.letters,
      "give the device no more than so many letters, all words together; 10000 if not given")
      ->transform(whole(1, std::numeric_limits<std::int64_t>::max()));
  add("--quiet", settings.quiet,
      "how long the device may take to end what it does by itself, in its own time (default: as "
      "its entry says)")
      ->type_name("SECONDS")
      ->check(number(0.001, 3600));
  add("--speed", settings.speed,
      "of a device that is not emulated and has a faster clock; 1 if not given")
      ->check(number(0.001, 1000));
  add("--draw", settings.drawing, "the machines as .dot, .svg, .json or .html")->type_name("FILE");
}

Exit learn(const LearnRun& run) {
  const auto machines = chosen_machines(run.device, run.settings.machine);
  if (!machines) return report(machines.error());
  const auto& path = run.settings.drawing;
  const auto* const form = mealy::drawing_form_of(path);
  if (!path.empty() && form == nullptr) {
    return report(Problem{ErrorCode::kBadValue, "--draw " + path,
                          "a drawing ends with .dot, .svg, .json or .html"});
  }
  const auto drawing = open_output("--draw", path);
  if (!drawing) return report(drawing.error());
  const auto files = ReportOutputs::open(run.files);
  if (!files) return report(files.error());
  const Signals signals;
  Learning learning{run, signals};
  std::vector<Lesson> lessons;
  for (const auto* const machine : *machines) {
    auto lesson = learning.learn(*machine);
    if (!lesson) return signals.has_come() ? signals.exit() : report(lesson.error());
    lessons.push_back(*std::move(lesson));
  }
  const auto result = lessons_report(run, lessons, learning.used());
  fmt::print("{}", to_text(result, style_of(run.colour, stdout)));
  files->put(result);
  if (*drawing) {
    std::vector<mealy::Drawing> drawings;
    for (auto& lesson : lessons) drawings.push_back(std::move(lesson.drawing));
    (void)(*drawing)->put(form->text_of(drawings));
  }
  return signals.has_come() ? signals.exit() : static_cast<Exit>(conclusion_of(result));
}

}  // namespace armjig::cli
