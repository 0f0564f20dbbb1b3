// SPDX-License-Identifier: Apache-2.0
#include "conformance/mutation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "conformance/in_parallel.hpp"
#include "conformance/selection.hpp"
#include "harness/core/version.hpp"
#include "harness/rig/target.hpp"

namespace armjig {
namespace {

constexpr std::uint64_t kSeed = 1;
/// The mutants were made for it: what it is held to tells what a fault breaks elsewhere, and most
/// equivalent faults are known for it.
constexpr Profile kShipped = Profile::kFirmware;

using Cases = std::vector<const Case*>;

/// The emulated device with all that its suite is about, and a fault if there is one.
std::string target_of(std::string_view equipment, std::string_view fault) {
  std::string text{"emulated:"};
  if (!equipment.empty()) text.append("?").append(equipment);
  if (!fault.empty()) text.append(equipment.empty() ? "?" : "&").append("fault=").append(fault);
  return text;
}

RigOptions target_with(std::string_view equipment, std::string_view fault, Profile profile) {
  RigOptions how;
  how.target = *parse_target(target_of(equipment, {}));
  how.target.text = target_of(equipment, fault);
  how.target.options["profile"] = to_string(profile);
  if (!fault.empty()) how.target.options["fault"] = fault;
  how.permissions = Permissions::all();
  return how;
}

/// One device on which cases are run, one after the other.
class Trial {
 public:
  Trial(std::unique_ptr<Bench> bench, Profile profile)
      : bench_{std::move(bench)}, profile_{profile} {}

  /// False: there is no sign of life.
  bool begin() {
    bench_->begin(profile_, kSeed);
    if (!bench_->is_alive()) return false;
    bench_->measure_noise();
    bench_->know_link(Duration{});
    return true;
  }

  /// What the case finds wrong; none if nothing, or if its start is out of reach.
  std::optional<std::string> finding(const Case& one) {
    if (unreachable_.contains(one.start)) return std::nullopt;
    bench_->begin(profile_, kSeed);
    bench_->bring_to(one.start);
    if (bench_->judgement().verdict != Verdict::kPass) {
      unreachable_.insert(one.start);
      if (obstacle_.empty()) obstacle_ = failure().value_or("");
      return std::nullopt;
    }
    bench_->begin(profile_, kSeed);
    one.run(*bench_);
    return failure();
  }

  /// What is wrong with a device that cannot be brought to a start; empty if nothing is.
  [[nodiscard]] const std::string& obstacle() const noexcept { return obstacle_; }

 private:
  [[nodiscard]] std::optional<std::string> failure() const {
    const auto& judgement = bench_->judgement();
    if (judgement.verdict != Verdict::kFail) return std::nullopt;
    return fmt::format("expected {}, got {}", judgement.expected, judgement.actual);
  }

  std::unique_ptr<Bench> bench_;
  Profile profile_;
  std::set<std::uint8_t> unreachable_;
  std::string obstacle_;
};

bool is_hinted(const Case& one, std::span<const SectionHints> hints, std::string_view section) {
  const auto found = std::ranges::find(hints, section, &SectionHints::section);
  if (found == hints.end()) return false;
  return std::ranges::any_of(found->requirements, [&](std::string_view hint) {
    return !hint.empty() && one.requirement.starts_with(hint);
  });
}

class Mutation {
 public:
  Mutation(const Suite& suite, const MutantsEntry& entry, const OpenBench& open,
           const MutationOptions& options)
      : suite_{suite}, entry_{entry}, open_{open}, options_{options} {}

  Outcome<MutationResult> run() {
    result_.equipment = entry_.equipment;
    if (auto tried = try_sound(); !tried) return tl::unexpected{tried.error()};
    for (auto& mutant : mutants_of(entry_, options_.profile)) {
      if (mutant.name.find(options_.filter) == std::string::npos) continue;
      result_.fates.push_back({std::move(mutant)});
    }
    try_all();
    if (options_.profile != kShipped) excuse_survivors();
    if (options_.proves_requirements && !options_.must_stop()) prove_requirements();
    if (options_.must_stop()) result_.unproven.clear();
    return std::move(result_);
  }

 private:
  /// Those that were written for something.
  [[nodiscard]] Cases cases_of(Profile profile) const {
    auto cases = select(suite_, profile, {});
    std::erase_if(cases, [](const Case* one) { return one->is_search; });
    return cases;
  }

  /// Only what passes on a sound device can show a fault.
  Outcome<void> try_sound() {
    auto trial = open({}, options_.profile);
    if (!trial) return tl::unexpected{trial.error()};
    (void)trial->begin();
    for (const auto* one : cases_of(options_.profile)) {
      if (options_.must_stop()) break;
      if (trial->finding(*one)) {
        result_.broken_on_sound.push_back(name_of(*one));
      } else {
        cases_.push_back(one);
      }
    }
    if (!trial->obstacle().empty()) {
      result_.broken_on_sound.push_back(fmt::format("{}.start", suite_.device));
    }
    return {};
  }

  [[nodiscard]] Outcome<Trial> open(std::string_view fault, Profile profile) const {
    auto bench = open_(target_with(entry_.equipment, fault, profile));
    if (!bench) return tl::unexpected{bench.error()};
    return Trial{*std::move(bench), profile};
  }

  /// A section is the work of one thread: what is found there shapes the order of what follows.
  void try_all() {
    std::map<std::string, std::vector<MutantFate*>> sections;
    for (auto& fate : result_.fates) sections[fate.mutant.section].push_back(&fate);
    std::vector<std::vector<MutantFate*>> work;
    for (auto& [name, fates] : sections) {
      constexpr std::size_t kPiece = 32;
      for (std::size_t i = 0; i < fates.size(); i += kPiece) {
        const auto end = std::min(i + kPiece, fates.size());
        work.emplace_back(fates.begin() + static_cast<std::ptrdiff_t>(i),
                          fates.begin() + static_cast<std::ptrdiff_t>(end));
      }
    }
    in_parallel(options_.threads, work.size(), [&](std::size_t i) { try_section(work[i]); });
  }

  void try_section(const std::vector<MutantFate*>& fates) const {
    auto order = cases_;
    const auto& section = fates.front()->mutant.section;
    std::ranges::stable_partition(
        order, [&](const Case* one) { return is_hinted(*one, entry_.hints, section); });
    for (auto* fate : fates) {
      fate->was_tried = !options_.must_stop();
      if (!fate->was_tried) continue;
      const auto killer = try_mutant(*fate, order);
      if (killer != order.end()) std::rotate(order.begin(), killer, killer + 1);
      if (!fate->killer.empty() || !fate->mutant.equivalent.empty()) continue;
      auto as_in_a_run = cases_;  // what a case finds may hang on what was done before it
      (void)try_mutant(*fate, as_in_a_run);
    }
  }

  [[nodiscard]] Cases::iterator try_mutant(MutantFate& fate, Cases& order) const {
    auto trial = open(fate.mutant.name, options_.profile);
    if (!trial) {
      fate.finding = trial.error().where + ": " + trial.error().hint;
      return order.end();
    }
    if (!trial->begin()) {
      fate.killer = fmt::format("{}.alive", suite_.device);
      fate.finding = "no sign of life";
      return order.end();
    }
    for (auto one = order.begin(); one != order.end(); ++one) {
      if (options_.must_stop()) {
        fate.was_tried = false;
        return order.end();
      }
      auto finding = trial->finding(**one);
      if (!finding) continue;
      fate.killer = name_of(**one);
      fate.finding = *std::move(finding);
      return one;
    }
    if (!trial->obstacle().empty()) {
      fate.killer = fmt::format("{}.start", suite_.device);
      fate.finding = trial->obstacle();
    }
    return order.end();
  }

  /// A fault may break only what shipped devices do and this profile leaves open. One that breaks
  /// something that both demand, and yet was not found, remains a survivor.
  void excuse_survivors() {
    const auto shipped_cases = cases_of(kShipped);
    std::set<std::string_view> demanded;
    for (const auto* one : cases_) demanded.insert(one->requirement);
    in_parallel(options_.threads, result_.fates.size(), [&](std::size_t i) {
      auto& [mutant, killer, finding, was_tried] = result_.fates[i];
      if (options_.must_stop()) was_tried = was_tried && !killer.empty();
      if (!was_tried) return;
      if (!killer.empty()) mutant.equivalent.clear();  // here it is not
      if (!killer.empty() || !mutant.equivalent.empty()) return;
      const auto broken = broken_when_shipped(mutant, shipped_cases);
      was_tried = !options_.must_stop();
      const bool is_left_open =
          std::ranges::none_of(broken, [&](std::string_view id) { return demanded.contains(id); });
      if (broken.empty() || !is_left_open) return;
      mutant.equivalent = fmt::format("the profile leaves open what it breaks, {}", broken.front());
    });
  }

  [[nodiscard]] std::vector<std::string_view> broken_when_shipped(const Mutant& mutant,
                                                                  const Cases& cases) const {
    auto trial = open(mutant.name, kShipped);
    if (!trial || !trial->begin()) return {};
    std::vector<std::string_view> broken;
    for (const auto* one : cases) {
      if (options_.must_stop()) return {};
      if (trial->finding(*one)) broken.push_back(one->requirement);
    }
    return broken;
  }

  void prove_requirements() {
    std::set<std::string_view> proven;
    for (const auto& fate : result_.fates) {
      for (const auto* one : cases_) {
        if (name_of(*one) == fate.killer) proven.insert(one->requirement);
      }
    }
    std::vector<const Requirement*> open_ones;
    for (const auto* one : cases_) {
      const auto& requirement = requirement_of(suite_, *one);
      if (requirement.level != Level::kMust || !proven.insert(requirement.id).second) continue;
      open_ones.push_back(&requirement);
    }
    std::vector<char> is_proven(open_ones.size());
    in_parallel(options_.threads, open_ones.size(),
                [&](std::size_t i) { is_proven[i] = breaks_on_a_mutant(*open_ones[i]) ? 1 : 0; });
    for (std::size_t i = 0; i < open_ones.size(); ++i) {
      if (is_proven[i] == 0) result_.unproven.push_back(open_ones[i]);
    }
  }

  /// Tries mutants of the sections that hint at the requirement first.
  [[nodiscard]] bool breaks_on_a_mutant(const Requirement& requirement) const {
    Cases own;
    std::ranges::copy_if(cases_, std::back_inserter(own),
                         [&](const Case* one) { return one->requirement == requirement.id; });
    std::vector<const Mutant*> order;
    for (const auto& fate : result_.fates) order.push_back(&fate.mutant);
    std::ranges::stable_partition(order, [&](const Mutant* mutant) {
      return is_hinted(*own.front(), entry_.hints, mutant->section);
    });
    return std::ranges::any_of(order, [&](const Mutant* mutant) {
      if (options_.must_stop()) return true;
      auto trial = open(mutant->name, options_.profile);
      if (!trial || !trial->begin()) return false;
      return std::ranges::any_of(own,
                                 [&](const Case* one) { return trial->finding(*one).has_value(); });
    });
  }

  const Suite& suite_;
  const MutantsEntry& entry_;
  const OpenBench& open_;
  const MutationOptions& options_;
  Cases cases_;
  MutationResult result_;
};

ReportRow row_of(const MutantFate& fate, const Suite& suite, std::string_view equipment,
                 const MutationOptions& options) {
  const auto& mutant = fate.mutant;
  const bool is_killed = !fate.killer.empty();
  const bool is_expected = is_killed == mutant.equivalent.empty();
  ReportRow row;
  row.name = fmt::format("{}.mutant.{}", suite.device, mutant.name);
  row.summary = fmt::format("A device with {} is found ({}).", mutant.name, mutant.section);
  row.verdict = is_killed ? Verdict::kPass : Verdict::kDeviation;
  if (!is_expected) row.verdict = Verdict::kFail;
  row.expected =
      mutant.equivalent.empty() ? "a case that fails" : "to survive: " + mutant.equivalent;
  row.actual = is_killed                   ? fmt::format("{}: {}", fate.killer, fate.finding)
               : mutant.equivalent.empty() ? "it survived " + fate.finding
                                           : "it survived: " + mutant.equivalent;
  if (!fate.was_tried) {
    row.verdict = Verdict::kSkipped;
    row.actual = "the run was interrupted";
  }
  row.repeat = fmt::format("armjig conformance {} --target '{}' --profile {}", suite.device,
                           target_of(equipment, mutant.name), to_string(options.profile));
  return row;
}

ReportSection rates_of(const MutationResult& result) {
  struct Count {
    std::size_t all = 0;
    std::size_t equivalent = 0;
    std::size_t killed = 0;
  };
  std::map<std::string, Count> counts;
  for (const auto& fate : result.fates) {
    if (!fate.was_tried) continue;
    for (auto* count : {&counts[fate.mutant.section], &counts["all"]}) {
      ++count->all;
      count->equivalent += fate.mutant.equivalent.empty() ? 0 : 1;
      count->killed += fate.killer.empty() || !fate.mutant.equivalent.empty() ? 0 : 1;
    }
  }
  ReportSection section{.title = "Kill rate by section"};
  section.table.columns = {"section", "mutants", "equivalent", "killed", "rate"};
  for (const auto& [name, count] : counts) {
    const auto due = count.all - count.equivalent;
    const auto rate =
        due == 0 ? 100.0 : 100.0 * static_cast<double>(count.killed) / static_cast<double>(due);
    section.table.rows.push_back({name, std::to_string(count.all), std::to_string(count.equivalent),
                                  std::to_string(count.killed), fmt::format("{:.1f} %", rate)});
  }
  return section;
}

}  // namespace

std::vector<Mutant> mutants_of(const MutantsEntry& entry, Profile profile) {
  std::vector<Mutant> all;
  for (auto& fault : entry.faults()) {
    Mutant mutant{std::move(fault.name), std::move(fault.section)};
    for (const auto& known : entry.equivalents) {
      const bool applies = known.profile == profile || known.profile == kShipped;
      if (known.name == mutant.name && applies) mutant.equivalent = known.reason;
    }
    all.push_back(std::move(mutant));
  }
  return all;
}

Outcome<MutationResult> run_mutants(const Suite& suite, const MutantsEntry& entry,
                                    const OpenBench& open, const MutationOptions& options) {
  return Mutation{suite, entry, open, options}.run();
}

Report to_report(const MutationResult& result, const Suite& suite, const MutationOptions& options) {
  Report report;
  report.title = fmt::format("Mutants of {}", suite.device);
  report.facts = {{"profile", std::string{to_string(options.profile)}},
                  {"catalogue", std::string{suite.version}},
                  {"armjig", std::string{kVersion}},
                  {"mutants", std::to_string(result.fates.size())}};
  for (const auto& name : result.broken_on_sound) {
    ReportRow row;
    row.verdict = Verdict::kError;
    row.name = name;
    row.summary = "A case passes on the device without a fault.";
    row.actual = "it fails, and was left out";
    report.rows.push_back(std::move(row));
  }
  for (const auto& fate : result.fates)
    report.rows.push_back(row_of(fate, suite, result.equipment, options));
  for (const auto* requirement : result.unproven) {
    ReportRow row;
    row.verdict = Verdict::kFail;
    row.name = fmt::format("{}.unproven", requirement->id);
    row.summary = "A must-requirement is broken by at least one mutant.";
    row.demand = requirement->text;
    row.actual = "by none";
    report.rows.push_back(std::move(row));
  }
  for (auto& row : report.rows) row.document = suite.document.path;
  report.sections.push_back(rates_of(result));
  return report;
}

}  // namespace armjig
