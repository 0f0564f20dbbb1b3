// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "cli/device.hpp"
#include "cli/diff.hpp"
#include "cli/foreign_options.hpp"
#include "cli/outputs.hpp"
#include "cli/recorded_session.hpp"
#include "cli/replaying.hpp"
#include "emulators/shadow/fit.hpp"
#include "harness/report/wording.hpp"

namespace armjig::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr auto kFitHelp =
    "Finds the options with which the emulated device is your board, from a recording of it.\n"
    "\n"
    "  armjig shadow fit session.pcapng                what the board's figures are, and which of\n"
    "                                                  them the recording cannot tell\n"
    "  armjig shadow fit session.jsonl --rules r.toml  differences are counted under these rules\n"
    "\n"
    "The recording begins when the board is switched on. Each figure comes from what depends on "
    "it\n"
    "alone, one after the other, with the least and the most that it may be. At the end the\n"
    "recording is replayed without and with the options that were found.\n"
    "\n"
    "Exit codes: 0 figures were told, 2 usage or no recording of a device, 4 none could be told.";

/// What differs so soon was so before.
constexpr Duration kBeginning = std::chrono::milliseconds{100};
constexpr auto kFromTheBeginning =
    "so it is from the beginning: was the board switched on before that, or has it what an option "
    "names (armjig emulate DEVICE --help)?";

struct FitOptions {
  std::string file;
  std::string rules;
  bool wants_json = false;
  ForeignOptions foreign;
};

/// How many of its messages a device with such options says otherwise.
struct Distance {
  std::size_t differences{};
  std::size_t messages{};
  std::string first;             ///< what differs first, one line
  bool is_from_the_beginning{};  ///< the device has said nothing for long before it

  [[nodiscard]] static Distance of(const TalkReplay& replay, const ComparisonRules& rules);
};

Distance Distance::of(const TalkReplay& replay, const ComparisonRules& rules) {
  const auto found = diff(replay.recorded, replay.emulated, rules);
  Distance distance{.differences = found.size(), .messages = replay.recorded.count()};
  if (found.empty()) return distance;
  const auto& first = found.front();
  const auto& message = (first.before != nullptr ? first.before : first.after)->message;
  distance.first = fmt::format("{:.6f} s, {}, '{}' {}: {}", seconds(first.time()), first.lane,
                               message.name.empty() ? "bytes" : message.name,
                               to_string(first.change), fmt::join(first.what, "; "));
  distance.is_from_the_beginning =
      first.time() <= replay.recorded.lanes().at(first.lane).front().message.time + kBeginning;
  return distance;
}

std::string to_target(const DeviceOptions& options) {
  std::string text = "emulated:";
  for (const auto& [name, value] : options) {
    text += fmt::format("{}{}={}", text.ends_with(':') ? "?" : "&", name, value);
  }
  return text;
}

/// A recording, and emulated devices that hear its host.
class Fitting {
 public:
  Fitting(Devices devices, const FitOptions& options, const KnownSession& known,
          ComparisonRules rules, ForeignHow foreign)
      : devices_{devices},
        path_{options.file},
        known_{known},
        rules_{std::move(rules)},
        foreign_{std::move(foreign)} {}

  [[nodiscard]] FitTalk talk() const {
    FitTalk talk{said(), [this](const DeviceOptions& options) { return play(options); }};
    return talk;
  }

  [[nodiscard]] Outcome<Distance> distance(const DeviceOptions& options) const {
    return play(options).map(
        [this](const TalkReplay& replay) { return Distance::of(replay, rules_); });
  }

 private:
  [[nodiscard]] std::vector<FitTalk::Said> said() const {
    std::vector<FitTalk::Said> said;
    std::map<std::uint32_t, std::unique_ptr<Dissector>> dissectors;
    const auto is_bus = known_.session.link.kind == LinkKind::kBus;
    for (const auto& record : known_.session.records) {
      if (!is_talk(record.kind)) continue;
      auto& dissector = dissectors[is_bus ? 0 : record.id];
      if (!dissector) dissector = known_.device->make_dissector();
      const auto bytes = is_bus ? bus_message_of(record.on(known_.session.link)) : record.bytes;
      std::vector<Message> messages;
      if (!bytes.empty()) dissector->feed(record.direction, record.time, bytes, messages);
      for (auto& message : messages) said.push_back({record.id, std::move(message)});
    }
    return said;
  }

  [[nodiscard]] Outcome<TalkReplay> play(DeviceOptions options) const {
    // One without any option would be like the recorded one.
    options.emplace(kClock.name, "0");
    Target target{.text = to_target(options),
                  .scheme = "emulated",
                  .address = {},
                  .options = std::move(options)};
    ReplayHow how{.rig = {.target = std::move(target)}, .rules = rules_, .foreign = foreign_};
    return replay_session(devices_, known_, path_, how, Compare::kNo)
        .map([](ReplayedRecording replayed) {
          return TalkReplay{std::move(replayed.expected), std::move(replayed.actual)};
        });
  }

  Devices devices_;
  std::string path_;
  const KnownSession& known_;
  ComparisonRules rules_;
  ForeignHow foreign_;
};

std::string text_of(const FigureEstimate& one, std::string_view unit) {
  return fmt::format("{}{}{:.6g} to {:.6g}{}{}", one.part, one.part.empty() ? "" : " ", one.least,
                     one.most, unit.empty() ? "" : " ", unit);
}

void print_figure(const FittedFigure& one) {
  const auto& [figure, answer] = one;
  fmt::print("{:<12} {}\n", figure.option, answer.value.empty() ? "not told" : answer.value);
  for (const auto& estimate : answer.estimates) {
    fmt::print("{:<12} {}\n", "", text_of(estimate, figure.unit));
  }
  fmt::print("{:<12} {}\n", "", wording::line(answer.basis));
}

Json json_of(const FittedFigure& one) {
  const auto& [figure, answer] = one;
  Json json{{"option", figure.option}, {"unit", figure.unit}, {"basis", answer.basis}};
  if (!answer.value.empty()) json["value"] = answer.value;
  json["estimates"] = Json::array();
  for (const auto& estimate : answer.estimates) {
    Json entry{{"value", estimate.value}, {"least", estimate.least}, {"most", estimate.most}};
    if (!estimate.part.empty()) entry["part"] = estimate.part;
    json["estimates"].push_back(std::move(entry));
  }
  return json;
}

void print_text(const Fit& found, const Distance& before, const Distance& after) {
  for (const auto& one : found.figures) print_figure(one);
  fmt::print("{}\n", to_target(found.options));
  fmt::print("differences in {} messages: {}, with the usual options {}\n", after.messages,
             after.differences, before.differences);
  if (after.differences == 0) return;
  fmt::print("the first: {}\n", wording::line(after.first));
  if (after.is_from_the_beginning) fmt::print("{}\n", kFromTheBeginning);
}

void print_json(const Fit& found, const Distance& before, const Distance& after) {
  Json json{{"schema", "armjig.fit/1"},
            {"target", to_target(found.options)},
            {"messages", after.messages},
            {"differences", after.differences},
            {"differences_before", before.differences},
            {"figures", Json::array()}};
  if (after.differences > 0) {
    json["first_difference"] = after.first;
    json["differs_from_the_beginning"] = after.is_from_the_beginning;
  }
  for (const auto& one : found.figures) json["figures"].push_back(json_of(one));
  fmt::print("{}\n", json.dump());
}

Outcome<Exit> fit_session(const Fitting& fitting, const Device& device, bool wants_json) {
  const auto found = fit(device.figures(), fitting.talk());
  if (!found) return tl::unexpected{found.error()};
  const auto before = fitting.distance({});
  if (!before) return tl::unexpected{before.error()};
  const auto after = fitting.distance(found->options);
  if (!after) return tl::unexpected{after.error()};
  wants_json ? print_json(*found, *before, *after) : print_text(*found, *before, *after);
  return found->options.empty() ? Exit::kNothing : Exit::kPassed;
}

Exit fit_file(Devices devices, const FitOptions& options) {
  auto rules = rules_of(options.rules);
  if (!rules) return report(rules.error());
  auto foreign = foreign_how(devices, options.foreign, {});
  if (!foreign) return report(foreign.error());
  const auto known = read_known_session(devices, options.file, *foreign);
  if (!known) {
    (void)report(known.error());
    return Exit::kUsage;
  }
  if (known->device->figures == nullptr) {
    (void)report({ErrorCode::kUnsupported, options.file,
                  fmt::format("nobody has said how figures of {} are told from a recording",
                              known->device->name)});
    return Exit::kNothing;
  }
  const auto claimed = claim_standard_output(options.wants_json ? "--json" : "");
  if (!claimed) return report(claimed.error());
  const Fitting fitting{devices, options, *known, *std::move(rules), *std::move(foreign)};
  const auto done = fit_session(fitting, *known->device, options.wants_json);
  return done ? *done : report(done.error());
}

}  // namespace

void add_shadow(CLI::App& app, Devices devices, Action& action) {
  auto* shadow = app.add_subcommand("shadow", "Emulated devices beside your board: their figures");
  shadow->require_subcommand(1);
  auto* command = shadow->add_subcommand("fit", kFitHelp);
  const auto options = std::make_shared<FitOptions>();
  command->add_option("FILE", options->file, "a recording, '-' for standard input")->required();
  command->add_option("--rules", options->rules, "what may differ, TOML (docs/captures.md)")
      ->type_name("FILE");
  command->add_flag("--json", options->wants_json, "one JSON object (docs/schemas)");
  add_foreign_options(*command, options->foreign);
  command->callback([options, devices, &action] {
    action = [options, devices] { return fit_file(devices, *options); };
  });
}

}  // namespace armjig::cli
