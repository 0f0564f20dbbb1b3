// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "harness/compare/recording_diff.hpp"
#include "harness/compare/rules.hpp"

namespace armjig {

/// Compares messages of one lane under the rules, which must outlive it.
class Likeness {
 public:
  explicit Likeness(const ComparisonRules& rules) : rules_{rules} {}

  /// All of it: a message may have come in parts. How many there were does not matter.
  [[nodiscard]] bool is_in_time(const RecordedMessage& one, const RecordedMessage& other) const {
    return !first_apart(one, other);
  }
  [[nodiscard]] bool has_same_content(const RecordedMessage& a, const RecordedMessage& b) const;
  /// Whether it says what others of its name come past within the tolerance of time, before or
  /// after: each state as one of them, each number between their least and their most. For who
  /// cannot know to the millisecond when something was so.
  template <class... Messages>
  [[nodiscard]] bool is_come_past_by(const RecordedMessage& one, const Messages&... others) const {
    std::vector<const RecordedMessage*> near;
    const auto add = [&](const auto& some) {
      for (const auto& other : some) {
        if (other.message.name == one.message.name && is_in_time(one, other))
          near.push_back(&other);
      }
    };
    (add(others), ...);
    return is_among(one, near);
  }
  /// What differs beyond the rules: time, note, rest, fields or bytes, `NAME: ONE, OTHER`.
  [[nodiscard]] std::vector<std::string> differences(const RecordedMessage& a,
                                                     const RecordedMessage& b) const;

 private:
  [[nodiscard]] bool is_among(const RecordedMessage& one,
                              std::span<const RecordedMessage* const> others) const;

  using Times = std::pair<Instant, Instant>;
  /// When the first part of both came that is too early or too late.
  [[nodiscard]] std::optional<Times> first_apart(const RecordedMessage& one,
                                                 const RecordedMessage& other) const;

  const ComparisonRules& rules_;
};

}  // namespace armjig
