// SPDX-License-Identifier: Apache-2.0
#include "cli/parol6/script_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "cli/checks.hpp"
#include "cli/choice.hpp"
#include "harness/arm/orientation.hpp"
#include "harness/core/number.hpp"
#include "harness/files/user_file.hpp"
#include "harness/motion/parol6/joint_table.hpp"
#include "harness/script/check.hpp"
#include "harness/script/parser.hpp"

namespace armjig::cli {
namespace {

/// Six whole numbers of 24 bits with commas between them.
std::optional<parol6::JointSteps> parse_places(std::string_view text) {
  constexpr std::int32_t kMost = 1 << 23;
  parol6::JointSteps places;
  for (std::size_t j = 0; j < places.size(); ++j) {
    const auto word = text.substr(0, text.find(','));
    const auto value = whole_text_as<std::int32_t>(word);
    const bool is_last = j + 1 == places.size();
    if (!value || *value < -kMost || *value >= kMost || is_last != (word.size() == text.size())) {
      return std::nullopt;
    }
    places[j] = Steps{*value};
    if (!is_last) text.remove_prefix(word.size() + 1);
  }
  return places;
}

}  // namespace

void add_script_options(CLI::App& app, ScriptOptions& options) {
  app.add_option("FILE", options.file, "the program, '-' for standard input")->required();
  app.add_option("--dialect", options.dialect,
                 "documented: the vendor's document made precise; commander: what its PC program "
                 "takes a line for")
      ->check(one_of({"documented", "commander"}))
      ->capture_default_str();
}

script::Dialect dialect_of(const ScriptOptions& options) {
  return options.dialect == "commander" ? script::Dialect::kCommander
                                        : script::Dialect::kDocumented;
}

Outcome<std::string> read_script_text(const ScriptOptions& options) {
  const bool is_stdin = options.file == "-";
  return (is_stdin ? UserFile::standard_input() : UserFile::open(options.file))
      .and_then([](UserFile file) { return file.rest(script::kMostBytes); });
}

tl::expected<script::Program, Exit> read_script(const ScriptOptions& options) {
  const auto text = read_script_text(options);
  if (!text) return tl::unexpected{report(text.error())};
  auto program = script::parse(*text, dialect_of(options));
  if (program) return *std::move(program);
  print_diagnostics(with_advice(program.error(), *text, options), options.file);
  return tl::unexpected{Exit::kUsage};
}

std::vector<script::Diagnostic> with_advice(std::vector<script::Diagnostic> errors,
                                            const std::string& text, const ScriptOptions& options) {
  const bool is_commander = dialect_of(options) == script::Dialect::kCommander;
  const auto other = is_commander ? script::Dialect::kDocumented : script::Dialect::kCommander;
  const auto program = script::parse(text, other);
  const auto is_error = [](const auto& one) { return one.severity == script::Severity::kError; };
  if (program && std::ranges::none_of(script::check(*program), is_error)) {
    errors.push_back({script::Severity::kNote, errors.front().place,
                      fmt::format("--dialect {} reads it", to_string(other))});
  }
  return errors;
}

void print_diagnostics(const std::vector<script::Diagnostic>& diagnostics, const std::string& file,
                       script::Severity least) {
  for (const auto& diagnostic : diagnostics) {
    if (diagnostic.severity >= least) fmt::print(stderr, "{}\n", describe(diagnostic, file));
  }
}

void add_planning_options(CLI::App& app, PlanningOptions& options) {
  app.add_option("--on-singularity", options.on_singularity,
                 "a line on which the tool would be lost: refuse it, stop in front of the place, "
                 "or try to go on; the commander always tries")
      ->check(one_of({"refuse", "stop", "try"}))
      ->capture_default_str();
  std::vector<std::string> names;
  for (const auto& convention : arm::conventions()) names.emplace_back(convention.name);
  app.add_option("--orientation", options.orientation, "what RX, RY and RZ of a pose mean")
      ->check(one_of(names))
      ->capture_default_str();
  app.add_option("--loops", options.loops, "passes of a program that ends with Loop()")
      ->transform(whole(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--gripper-id", options.gripper_id, "CAN node of the gripper")
      ->transform(whole(0, 15))
      ->capture_default_str();
  app.add_option("--from", options.from,
                 "where the plan begins: standby; power-up, all zeros, where joints have no limits "
                 "yet; or six numbers of steps")
      ->type_name("PLACE")
      ->capture_default_str();
}

Outcome<Planning> parse_planning(const PlanningOptions& options) {
  using parol6::planning::OnSingularity;
  Planning planning;
  auto& settings = planning.settings;
  settings.planner.on_singularity = options.on_singularity == "refuse" ? OnSingularity::kRefuse
                                    : options.on_singularity == "try"  ? OnSingularity::kTry
                                                                       : OnSingularity::kStop;
  const auto conventions = arm::conventions();
  settings.planner.convention =
      std::ranges::find(conventions, options.orientation, &arm::ConventionName::name)->convention;
  settings.passes = options.loops;
  settings.gripper_id = static_cast<std::uint8_t>(options.gripper_id);
  if (options.from == "power-up") {
    settings.planner.limits = parol6::planning::LimitCheck::kIgnored;
  } else if (options.from == "standby") {
    planning.start = parol6::kStandby;
  } else if (auto start = parse_places(options.from)) {
    planning.start = *start;
  } else {
    return problem(ErrorCode::kBadValue, "--from " + options.from,
                   "write standby, power-up, or six numbers of steps as in 0,-32000,57905,0,0,0");
  }
  return planning;
}

}  // namespace armjig::cli
