// SPDX-License-Identifier: Apache-2.0
#include "cli/trace_what_if.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/foreign_options.hpp"
#include "cli/program_trial.hpp"
#include "cli/recorded_session.hpp"
#include "conformance/in_parallel.hpp"
#include "emulators/replay/recorded_talk.hpp"
#include "harness/report/wording.hpp"

namespace armjig::cli {
namespace {

constexpr auto kWhatIfHelp =
    "Finds the least that a link could do to a talk so that it goes wrong.\n"
    "\n"
    "  armjig trace what-if session.jsonl                      with the host of the recording\n"
    "  armjig trace what-if session.jsonl --apart 1            also: the device goes another way\n"
    "  armjig trace what-if session.jsonl -- ./program {}      with a program that is started\n"
    "                                                          again for each try\n"
    "\n"
    "An emulated device like the recorded one hears the talk again and again, in which one piece "
    "is\n"
    "lost, doubled, late, or swapped with the next one, and if that breaks nothing, two of them. "
    "It\n"
    "ends with the first that breaks what is demanded of programs for the device, or makes the\n"
    "device say what is no message or end the connection.\n"
    "\n"
    "A program finds the device at {} (its port at {port}), or in ARMJIG_TARGET as --target has "
    "it.\n"
    "Then what the device says is perturbed, too, and a program that ends otherwise than usual, or "
    "not\n"
    "at all, has gone wrong. The device is as it was in the recording at --at.\n"
    "\n"
    "Exit codes: 0 nothing goes wrong, 1 something does, 2 usage, 3 program or link, 4 nothing to "
    "try.";

struct WhatIfOptions {
  std::string file;
  double at = 0;
  double delay = 0.1;
  std::size_t most = 2;
  std::size_t reach = 8;
  std::optional<double> apart;
  std::vector<std::string> ignored;
  double budget = 60;
  double patience = 10;
  double speed = 1;
  bool wants_json = false;
  ForeignOptions foreign;
  std::vector<std::string> program;
};

/// What was found, beside whose it is.
struct WhatIfResult {
  WhatIfAnswer answer;
  std::optional<Apart> apart;
};

WhatIfHow how_of(const WhatIfOptions& options) {
  const auto end = std::chrono::steady_clock::now() + duration_of(options.budget);
  return {.delay = duration_of(options.delay),
          .most = options.most,
          .reach = options.reach,
          .ignored = {options.ignored.begin(), options.ignored.end()},
          .must_stop = [end] { return std::chrono::steady_clock::now() >= end; }};
}

Outcome<WhatIfResult> with_recorded_host(RecordedHost host, KnownSession known,
                                         const WhatIfOptions& options) {
  const auto& device = *known.device;
  const auto talk =
      RecordedTalk::begin(std::move(host), std::move(known.session.records), device.make_dissector,
                          [&device] { return make_trial_judge(device, {}); });
  if (!talk) return tl::unexpected{talk.error()};
  const auto longest =
      options.apart ? std::optional{duration_of(*options.apart)} : std::optional<Duration>{};
  auto how = how_of(options);
  how.for_each = [](std::size_t count, const std::function<void(std::size_t)>& work) {
    in_parallel(std::max(1U, std::thread::hardware_concurrency()), count, work);
  };
  const auto trial = [&](const std::vector<Perturbation>& wanted) -> Outcome<TrialResult> {
    return (*talk)(wanted, longest);
  };
  auto answer = what_if(trial, how);
  if (!answer) return tl::unexpected{answer.error()};
  WhatIfResult result{*std::move(answer), std::nullopt};
  if (result.answer.found) {
    result.apart = talk->apart_after(result.answer.found->perturbations);
  }
  return result;
}

Outcome<WhatIfResult> with_program(RecordedHost host, const KnownSession& known,
                                   const WhatIfOptions& options) {
  const auto begin = cli::duration_of(options.at);
  for (const auto& record : known.session.records) {
    if (record.time >= at(begin)) break;
    host.play(record);
  }
  host.advance_to(at(begin));
  const auto now = host.now();
  const auto emulated = std::move(host).leave();
  ProgramTrial trial{.device = *known.device,
                     .emulated = emulated,
                     .begin = now,
                     .command = options.program,
                     .patience = duration_of(options.patience),
                     .speed = options.speed};
  auto how = how_of(options);
  how.confirmations = 1;
  const auto run = [&trial](const std::vector<Perturbation>& wanted) { return trial(wanted); };
  return what_if(run, how).map(
      [](WhatIfAnswer answer) { return WhatIfResult{std::move(answer), std::nullopt}; });
}

/// The emulated device like the recorded one, and the host that talks to it.
Outcome<RecordedHost> recorded_host(const KnownSession& known, const std::string& path) {
  return std::visit(
      [&](const auto& kind) -> Outcome<RecordedHost> {
        auto hosted = cli::emulate(kind, {{std::string{kLike}, path}}, path);
        if (!hosted) return tl::unexpected{hosted.error()};
        const bool works_in_passes = kind.set_up != nullptr && !known.session.is_of_capture;
        return RecordedHost{*std::move(hosted), known.device->replay.touches_of,
                            works_in_passes ? Duration{1} : Duration{}};
      },
      known.device->port);
}

std::string text_of(const Apart& apart) {
  std::string text =
      fmt::format("the device says something else {} {:.3f} s",
                  apart.is_to_the_end ? "to the end, from" : "from", seconds(apart.from));
  if (!apart.is_to_the_end) {
    text += fmt::format(" for {:.3f} s", wording::seconds(apart.to - apart.from));
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(apart.fields.size(), 4); ++i) {
    text += (i == 0 ? ": " : "; ") + apart.fields[i];
  }
  return text;
}

std::string effort_of(const WhatIfAnswer& answer, const WhatIfOptions& options) {
  return fmt::format(
      "{} pieces, {} perturbations tried{}", answer.undisturbed.passed.size(), answer.tried,
      answer.is_complete ? "" : fmt::format(", not all: --for {} s were over", options.budget));
}

void print_text(const WhatIfResult& result, const WhatIfOptions& options) {
  const auto& answer = result.answer;
  if (!answer.found) {
    fmt::print("nothing goes wrong\n");
  } else {
    const auto& [perturbations, times, broken, after] = *answer.found;
    fmt::print("{}\n  breaks {} at {:.3f} s: {}\n", wording::line(describe(*answer.found)),
               broken.rule, seconds(broken.time), wording::line(broken.what));
    if (result.apart) fmt::print("  {}\n", wording::line(text_of(*result.apart)));
  }
  fmt::print("{}\n", effort_of(answer, options));
}

nlohmann::ordered_json json_of(const WhatIfAnswer::Found& found) {
  auto perturbations = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < found.perturbations.size(); ++i) {
    const auto& one = found.perturbations[i];
    perturbations.push_back({{"kind", to_string(one.kind)},
                             {"direction", to_string(one.piece.direction)},
                             {"message", one.piece.name},
                             {"number", one.piece.nth},
                             {"t_s", seconds(found.times[i])}});
  }
  return {{"perturbations", std::move(perturbations)},
          {"rule", found.broken.rule},
          {"t_s", seconds(found.broken.time)},
          {"what", found.broken.what}};
}

void print_json(const WhatIfResult& result) {
  const auto& answer = result.answer;
  nlohmann::ordered_json json{{"schema", "armjig.what-if/1"},
                              {"pieces", answer.undisturbed.passed.size()},
                              {"tried", answer.tried},
                              {"complete", answer.is_complete}};
  json["found"] = answer.found ? json_of(*answer.found) : nlohmann::ordered_json{};
  if (result.apart) {
    json["apart"] = {{"from_s", seconds(result.apart->from)},
                     {"to_s", seconds(result.apart->to)},
                     {"to_the_end", result.apart->is_to_the_end},
                     {"fields", result.apart->fields}};
  }
  fmt::print("{}\n", json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void note_what_is_judged(const Device& device, const WhatIfOptions& options) {
  const bool is_little =
      !device.program_check && !options.apart && options.program.empty() && !options.wants_json;
  if (!is_little) return;
  fmt::print(stderr,
             "armjig: nothing is demanded of programs for {}: only what the device says is "
             "judged; --apart SECONDS judges where it goes\n",
             device.name);
}

Exit what_if_command(Devices devices, const WhatIfOptions& options) {
  const auto foreign = foreign_how(devices, options.foreign, {});
  if (!foreign) return report(foreign.error());
  auto known = read_known_session(devices, options.file, *foreign);
  if (!known) return report(known.error());
  note_what_is_judged(*known->device, options);
  auto host = recorded_host(*known, options.file);
  if (!host) return report(host.error());
  const auto result = options.program.empty()
                          ? with_recorded_host(*std::move(host), *std::move(known), options)
                          : with_program(*std::move(host), *known, options);
  if (!result) return report(result.error());
  options.wants_json ? print_json(*result) : print_text(*result, options);
  if (result->answer.undisturbed.passed.empty()) return Exit::kNothing;
  return result->answer.found ? Exit::kFindings : Exit::kPassed;
}

}  // namespace

void add_trace_what_if(CLI::App& trace, Devices devices, Action& action) {
  auto* command = trace.add_subcommand("what-if", kWhatIfHelp);
  const auto options = std::make_shared<WhatIfOptions>();
  command->add_option("FILE", options->file, "a recording")->required();
  const auto add_seconds = [&](const std::string& name, double& place, double least,
                               const std::string& meaning) {
    command->add_option(name, place, meaning)->type_name("SECONDS")->check(number(least, 1e6));
  };
  add_seconds("--delay", options->delay, 1e-6, "how late what is late is (default: 0.1)");
  add_seconds("--for", options->budget, 0, "time for all tries (default: 60)");
  command
      ->add_option("--apart", options->apart,
                   "also wrong: the device says something else for longer than that")
      ->type_name("SECONDS")
      ->check(number(0, 1e6));
  command->add_option("--most", options->most, "perturbations together (default: 2)")
      ->type_name("N")
      ->transform(whole(1, 2));
  command
      ->add_option("--reach", options->reach,
                   "the second is among so many pieces after the first (default: 8)")
      ->type_name("N")
      ->transform(whole(1, 1000));
  command->add_option("--ignore", options->ignored, "a rule that may be broken; may be repeated")
      ->type_name("RULE");
  command->add_flag("--json", options->wants_json, "one JSON object");
  add_seconds("--at", options->at, 0, "where in the recording the program starts (default: 0)");
  add_seconds("--patience", options->patience, 0.001, "by when a program has to end (default: 10)");
  command
      ->add_option("--speed", options->speed,
                   "device time over wall time, with a program (default: 1)")
      ->type_name("FACTOR")
      ->check(number(0.001, 1000));
  add_foreign_options(*command, options->foreign);
  command->add_option("PROGRAM", options->program, "and its arguments, behind --")->type_name("");
  when_chosen(*command, action, [options, devices] { return what_if_command(devices, *options); });
}

}  // namespace armjig::cli
