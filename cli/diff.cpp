// SPDX-License-Identifier: Apache-2.0
#include "cli/diff.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/device.hpp"
#include "cli/foreign_options.hpp"
#include "cli/outputs.hpp"
#include "conformance/suite.hpp"
#include "harness/capture/message_json.hpp"
#include "harness/compare/recording_diff.hpp"
#include "harness/compare/rules.hpp"
#include "harness/report/report.hpp"
#include "harness/report/wording.hpp"
#include "harness/wire/append_text.hpp"

namespace armjig::cli {
namespace {

using Json = nlohmann::ordered_json;
using Differences = std::vector<RecordingDifference>;

constexpr auto kDiffHelp =
    "Aligns two recordings, message by message, and says what differs, field by field.\n"
    "\n"
    "  armjig diff yesterday.pcapng today.pcapng\n"
    "  armjig diff a.jsonl b.pcapng --rules rules.toml     what may differ\n"
    "  armjig diff a.jsonl b.jsonl --html diff.html        side by side\n"
    "\n"
    "Messages are compared with those of the same direction and connection. They are changed,\n"
    "missing, extra or moved.";

struct DiffOptions {
  std::string before;
  std::string after;
  ComparisonOptions comparison;
  ForeignOptions foreign;
};

Outcome<void> read_messages(const std::string& path, const ForeignHow& how,
                            RecordedMessages& messages) {
  const auto reader = open_recording(path, how);
  if (!reader) return tl::unexpected{reader.error()};
  auto read = for_each_record(**reader, [&](const CaptureRecord& record) {
    return messages.add(record).map_error(
        [&path](const Problem& wrong) { return Problem{wrong.code, path, wrong.hint}; });
  });
  messages.finish();
  print_warning_of(**reader);
  return read;
}

std::string text_of(const RecordedMessage* message) {
  if (message == nullptr) return {};
  std::string text;
  append_content(text, message->message);
  if (!message->note.empty()) text += fmt::format(" {{{}}}", message->note);
  return wording::line(text);
}

std::string seconds_of(const RecordedMessage* message) {
  if (message == nullptr) return {};
  return fmt::format("{:.6f}", wording::seconds(message->message.time.time_since_epoch()));
}

/// How often each field, or `time`, `note` and `bytes`, differs.
std::map<std::string, std::size_t> by_field(const Differences& found) {
  std::map<std::string, std::size_t> counts;
  for (const auto& one : found) {
    for (const auto& what : one.what) ++counts[what.substr(0, what.find(':'))];
  }
  return counts;
}

/// A requirement, and how often what it speaks of differs.
struct Concerned {
  Requirement requirement;
  std::size_t times{};
};

/// What of a message differs, in the words of `Subject`.
std::vector<std::string_view> aspects_of(const RecordingDifference& one) {
  if (one.change == Change::kMissing || one.change == Change::kExtra) return {"message"};
  std::vector<std::string_view> aspects;
  for (const std::string_view what : one.what) aspects.push_back(what.substr(0, what.find(':')));
  return aspects;
}

/// By id. What no requirement speaks of is in none.
std::map<std::string_view, Concerned> by_requirement(const Differences& found, Devices devices) {
  std::map<std::string_view, Concerned> all;
  for (const auto& one : found) {
    // A lane begins with the device.
    const auto* const device =
        find_recorded_device(devices, one.lane.substr(0, one.lane.find(' ')));
    if (device == nullptr) continue;
    const auto suite = device->suite();
    const auto name = (one.before != nullptr ? one.before : one.after)->message.name;
    for (const auto aspect : aspects_of(one)) {
      const auto* const requirement = find_requirement_about(suite, name, aspect);
      if (requirement == nullptr) continue;
      ++all.try_emplace(requirement->id, Concerned{*requirement}).first->second.times;
    }
  }
  return all;
}

std::string summary_of(const Differences& found) {
  std::string text;
  for (const auto change : {Change::kChanged, Change::kMissing, Change::kExtra, Change::kMoved}) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ",
                        std::ranges::count(found, change, &RecordingDifference::change),
                        to_string(change));
  }
  return text;
}

void print_json(const Differences& found, Devices devices) {
  const auto message_of = [](const RecordedMessage& message) {
    auto json = message_object<Json>(message.message);
    if (!message.note.empty()) json["note"] = message.note;
    return json;
  };
  Json json{{"schema", "armjig.diff/1"}, {"equal", found.empty()}, {"fields", Json::object()}};
  for (const auto& [field, count] : by_field(found)) json["fields"][field] = count;
  json["requirements"] = Json::object();
  for (const auto& [id, concerned] : by_requirement(found, devices)) {
    json["requirements"][std::string{id}] = concerned.times;
  }
  json["differences"] = Json::array();
  for (const auto& one : found) {
    Json entry{{"change", to_string(one.change)}, {"lane", one.lane}, {"what", one.what}};
    if (one.before != nullptr) entry["before"] = message_of(*one.before);
    if (one.after != nullptr) entry["after"] = message_of(*one.after);
    json["differences"].push_back(std::move(entry));
  }
  fmt::print("{}\n", json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Report page_of(const Compared& compared, const Differences& found) {
  const auto& before = compared.before;
  const auto& after = compared.after;
  constexpr std::size_t kMostRows = 5'000;
  Report page;
  page.title = wording::line(fmt::format("{} and {}", before, after));
  page.facts.emplace_back("result", found.empty() ? "equal" : summary_of(found));
  if (found.size() > kMostRows) {
    page.facts.emplace_back("shown", fmt::format("the first {} differences", kMostRows));
  }
  auto& sides = page.sections.emplace_back();
  sides.title = "Side by side";
  sides.table.columns = {"change", "link", "s", before, "s", after, "differs"};
  for (const auto& one : std::span{found}.first(std::min(found.size(), kMostRows))) {
    std::string what;
    for (const auto& part : one.what) what += (what.empty() ? "" : "; ") + part;
    sides.table.rows.push_back({std::string{to_string(one.change)}, one.lane,
                                seconds_of(one.before), text_of(one.before), seconds_of(one.after),
                                text_of(one.after), what});
  }
  auto& fields = page.sections.emplace_back();
  fields.title = "By field";
  fields.table.columns = {"field", "times"};
  for (const auto& [field, count] : by_field(found)) {
    fields.table.rows.push_back({field, std::to_string(count)});
  }
  auto& requirements = page.sections.emplace_back();
  requirements.title = "By requirement";
  requirements.table.columns = {"requirement", "what it demands", "times"};
  for (const auto& [id, concerned] : by_requirement(found, compared.devices)) {
    requirements.table.rows.push_back({std::string{id}, std::string{concerned.requirement.text},
                                       std::to_string(concerned.times)});
  }
  return page;
}

}  // namespace

std::string describe(const Differences& found, Devices devices) {
  constexpr std::size_t kMostShown = 100;
  std::string text;
  const auto add = std::back_inserter(text);
  for (const auto& one : std::span{found}.first(std::min(found.size(), kMostShown))) {
    fmt::format_to(add, "{:>12} s {} {}\n",
                   seconds_of(one.before != nullptr ? one.before : one.after),
                   to_string(one.change), wording::line(one.lane));
    if (one.before != nullptr) fmt::format_to(add, "  before {}\n", text_of(one.before));
    if (one.after != nullptr) fmt::format_to(add, "  after  {}\n", text_of(one.after));
    for (const auto& what : one.what) fmt::format_to(add, "    {}\n", wording::line(what));
  }
  if (found.size() > kMostShown) fmt::format_to(add, "and {} more\n", found.size() - kMostShown);
  for (const auto& [field, count] : by_field(found)) {
    fmt::format_to(add, "{:>8} times {}\n", count, wording::line(field));
  }
  for (const auto& [id, concerned] : by_requirement(found, devices)) {
    fmt::format_to(add, "{:>8} times what {} speaks of: {}\n", concerned.times, id,
                   concerned.requirement.text);
  }
  fmt::format_to(add, "{}\n", found.empty() ? "equal" : "different: " + summary_of(found));
  return text;
}

Exit tell(const Differences& found, const Compared& compared, bool wants_json, const Output& html) {
  if (wants_json) {
    print_json(found, compared.devices);
  } else {
    fmt::print("{}", describe(found, compared.devices));
  }
  if (html) html->put(to_html(page_of(compared, found)));
  if (compared.messages == 0) return Exit::kNothing;
  return found.empty() ? Exit::kPassed : Exit::kFindings;
}

std::function<MakeDissector(std::string_view)> dissectors_of(Devices devices) {
  return [devices](std::string_view name) -> MakeDissector {
    const auto* const device = find_recorded_device(devices, name);
    return device == nullptr ? nullptr : device->make_dissector;
  };
}

Outcome<std::optional<ComparisonRules>> rules_asked_for(const std::string& path) {
  if (path.empty()) return std::nullopt;
  return ComparisonRules::read(path);
}

Outcome<ComparisonRules> rules_of(const std::string& path) {
  return rules_asked_for(path).map(
      [](const auto& rules) { return rules.value_or(ComparisonRules{}); });
}

Outcome<ComparisonRules> rules_beside(const Device& device, const Target& target,
                                      const std::string& path) {
  constexpr std::string_view kAnyDevice = "time_ms = 100\norder = \"free\"\n";
  if (!path.empty() || target.is_emulated()) return rules_of(path);
  const auto own = device.live_rules;
  return ComparisonRules::parse(own.empty() ? kAnyDevice : own,
                                fmt::format("the rules of {}", device.name));
}

namespace {

Exit compare(Devices devices, const DiffOptions& options) {
  const auto refuse = [](const Problem& problem) {
    (void)report(problem);
    return Exit::kUsage;
  };
  const auto rules = rules_of(options.comparison.rules);
  if (!rules) return refuse(rules.error());
  if (options.before == "-" && options.after == "-") {
    return refuse({ErrorCode::kBadValue, "B", "standard input can be read only once"});
  }
  const auto how = foreign_how(devices, options.foreign, {});
  if (!how) return refuse(how.error());
  const auto files = open_outputs({{"--html", options.comparison.html}});
  if (!files) return report(files.error());
  const auto find_dissector = dissectors_of(devices);
  RecordedMessages before{find_dissector};
  RecordedMessages after{find_dissector};
  if (const auto read = read_messages(options.before, *how, before); !read) {
    return refuse(read.error());
  }
  if (const auto read = read_messages(options.after, *how, after); !read) {
    return refuse(read.error());
  }
  const auto found = diff(before, after, *rules);
  return tell(found, {options.before, options.after, before.count() + after.count(), devices},
              options.comparison.wants_json, files->front());
}

}  // namespace

void add_comparison_options(CLI::App& app, ComparisonOptions& options) {
  app.add_option("--rules", options.rules, "what may differ, TOML (docs/captures.md)")
      ->type_name("FILE");
  app.add_flag("--json", options.wants_json, "one JSON object (docs/schemas)");
  app.add_option("--html", options.html, "a page, side by side")->type_name("FILE");
}

void add_diff(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("diff", kDiffHelp);
  const auto options = std::make_shared<DiffOptions>();
  command->add_option("A", options->before, "a recording, '-' for standard input")->required();
  command->add_option("B", options->after, "another one")->required();
  add_comparison_options(*command, options->comparison);
  add_foreign_options(*command, options->foreign);
  when_chosen(*command, action, [options, devices] { return compare(devices, *options); });
}

}  // namespace armjig::cli
