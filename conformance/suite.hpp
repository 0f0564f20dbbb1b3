// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/bench.hpp"
#include "conformance/requirement.hpp"
#include "harness/rig/guard.hpp"

namespace armjig {

enum class Tier : std::uint8_t { kQuick, kFull };

/// A check of one requirement: data, and a short straight body.
struct Case {
  std::string_view requirement{};  ///< `chapter` fills it in: the one above it
  std::string_view variant{};      ///< tells cases of one requirement apart; empty if there is one
  std::string_view rule;           ///< what happens, in one sentence
  CaseBody run;                    ///< passes unless it finds something
  Hazard hazard = Hazard::kObserve;  ///< the worst that it does to a device
  Tier tier = Tier::kQuick;
  std::uint8_t start = 0;  ///< the state that it needs, an index into the suite's
  /// It looks for whatever nobody thought of, so it says nothing of how good the other cases are.
  bool is_search = false;
};

/// A case that starts in the first state and does no more than to look. Without a rule, that of its
/// requirement is meant.
[[nodiscard]] constexpr Case look(std::string_view rule, CaseBody run) noexcept {
  return {.rule = rule, .run = run};
}
[[nodiscard]] constexpr Case look(CaseBody run) noexcept { return look({}, run); }

/// One that starts elsewhere or does more.
[[nodiscard]] constexpr Case from(std::uint8_t start, Hazard hazard, std::string_view rule,
                                  CaseBody run) noexcept {
  return {.rule = rule, .run = run, .hazard = hazard, .start = start};
}

[[nodiscard]] constexpr Case from(std::uint8_t start, Hazard hazard, CaseBody run) noexcept {
  return from(start, hazard, {}, run);
}

/// One of several of a requirement.
[[nodiscard]] constexpr Case variant(std::string_view name, Case one) noexcept {
  one.variant = name;
  return one;
}

/// One that takes too long for quick runs.
[[nodiscard]] constexpr Case full(Case one) noexcept {
  one.tier = Tier::kFull;
  return one;
}

/// The requirement's id, and the variant behind it: a name of its own for every case.
[[nodiscard]] std::string name_of(const Case& one);

/// The seed of a case's random bytes, which do not depend on which cases ran before.
[[nodiscard]] std::uint64_t seed_of(const Case& one, std::uint64_t seed);

/// A state of the device in which cases begin. Earlier ones of a suite are visited first, so that
/// what takes long, such as homing, is not done again and again.
struct StartState {
  std::string_view name;
  Hazard hazard{};  ///< of getting there
};

/// A line of a chapter: a requirement, or a case that checks the requirement above it.
struct Clause {
  Requirement requirement{};  ///< without an id: it is a case
  Case one{};

  constexpr Clause(const Requirement& that) noexcept  // NOLINT(*-explicit-*)
      : requirement{that} {}
  constexpr Clause(const Case& that) noexcept : one{that} {}  // NOLINT(*-explicit-*)
};

/// Requirements about one topic, and the cases that check them; a section of the specification.
struct Chapter {
  std::string_view title;
  std::vector<Requirement> requirements;
  std::vector<Case> cases;
};
[[nodiscard]] Chapter chapter(std::string_view title, std::span<const Clause> clauses);
[[nodiscard]] Chapter chapter(std::string_view title, std::span<const Requirement> requirements);

/// Of what in messages a requirement speaks, so that what differs in two recordings can be told by
/// requirements. Of several the one that names the message counts, then the longest field.
struct Subject {
  std::string_view message{};  ///< the kind; empty: any
  /// A field, or what it begins with up to a dot; `message`: that it comes; `time`: when; `note`:
  /// what was acknowledged; `bytes`: what no field has.
  std::string_view aspect;
  std::string_view requirement;  ///< its id
};

/// All that is known about one device.
struct Suite {
  std::string_view device;
  std::string_view version;  ///< of the catalogue; changes with every requirement and case
  std::span<const Chapter> chapters;
  std::span<const StartState> starts;
  Document document{};                  ///< none: reports name no place
  std::span<const Subject> subjects{};  ///< none: differences are told by field only
  /// Pieces of names of cases: what safety rests on, such as all ways to stop. They belong to every
  /// tier, and of those with the same start state they come first.
  std::span<const std::string_view> vital{};
};

/// Whether safety rests on what the case checks.
[[nodiscard]] bool is_vital(const Suite& suite, const Case& one);

/// The requirement of that id, or nullptr.
[[nodiscard]] const Requirement* find_requirement(const Suite& suite, std::string_view id) noexcept;

/// The requirement that speaks of that aspect of a message, as `Subject` has it, or nullptr.
[[nodiscard]] const Requirement* find_requirement_about(const Suite& suite,
                                                        std::string_view message,
                                                        std::string_view aspect) noexcept;

/// The requirement of a case. Every case has one; a test proves it.
[[nodiscard]] const Requirement& requirement_of(const Suite& suite, const Case& one) noexcept;

}  // namespace armjig
