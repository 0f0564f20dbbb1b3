// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "emulators/campaign/intervals.hpp"
#include "emulators/campaign/stage.hpp"
#include "harness/compare/rules.hpp"

namespace armjig::campaign {

/// What is wrong with what a device said.
struct Symptom {
  /// What counts as the same defect: what was asked, what answered, and each part of the answer
  /// that is wrong. `jog: telemetry: position.j1, speed.j1`.
  std::string asked;   ///< the last thing that was done before it, in words
  std::string answer;  ///< kind of the answer, or what became of it: `telemetry`, `silence`
  std::vector<std::string> parts;  ///< what of it is wrong: fields, `missing`, `extra`, `malformed`
  std::string expected{};          ///< by the model, in words; empty: there is none
  std::string actual{};
  Instant time{};  ///< since the case began

  [[nodiscard]] std::string key() const;
  /// The same, one for each part. Of a field that is wrong it does not say after what, and never
  /// how many messages came at once.
  [[nodiscard]] std::vector<std::string> ways() const;
};

/// Symptoms that are no news: parts of answers that were found wrong, or were known before.
class Excuses {
 public:
  /// Only after that question; with an empty `asked` after any.
  void add(std::string_view asked, std::string_view answer, std::string_view part);
  [[nodiscard]] bool has(std::string_view asked, std::string_view answer,
                         std::string_view part) const;
  [[nodiscard]] std::size_t size() const noexcept { return keys_.size(); }
  /// Fields that are excused after some question: they tell no message from another.
  [[nodiscard]] const std::vector<ComparisonRules::FieldRule>& fields() const noexcept {
    return fields_;
  }

 private:
  std::set<std::string, std::less<>> keys_;
  std::vector<ComparisonRules::FieldRule> fields_;
};

/// How both sides are compared.
struct Judging {
  MakeDissector make_dissector{};
  ComparisonRules rules;
  /// What comes later than the last record by more may still be under way.
  Duration horizon{};
  std::optional<ToldInterval> told_interval{};  ///< none: the device tells none
};

/// The first moment at which what the target said is wrong and not excused: its link ended and that
/// of no model did, or a message is there, or missing, that no model explains. None: all is well.
[[nodiscard]] std::optional<Symptom> symptom_of(const Script& script, const BothHeard& heard,
                                                const Judging& judging, const Excuses& excuses);

/// All that no model explains, as `Symptom::ways`, sorted. `found` is what was found before:
/// it is told, too, as far as `excuses` does not have it.
[[nodiscard]] std::vector<std::string> all_ways(const Script& script, const BothHeard& heard,
                                                const Judging& judging, const Excuses& excuses,
                                                const Excuses& found);

}  // namespace armjig::campaign
