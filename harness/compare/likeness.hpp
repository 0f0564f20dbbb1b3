// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "harness/compare/recording_diff.hpp"
#include "harness/compare/rules.hpp"

namespace armjig {

/// Compares messages of one lane under the rules, which must outlive it.
class Likeness {
 public:
  explicit Likeness(const ComparisonRules& rules) : rules_{rules} {}

  [[nodiscard]] bool is_in_time(const RecordedMessage& one, const RecordedMessage& other) const;
  [[nodiscard]] bool has_same_content(const RecordedMessage& a, const RecordedMessage& b) const;
  /// What differs beyond the rules: time, note, rest, fields or bytes, `NAME: ONE, OTHER`.
  [[nodiscard]] std::vector<std::string> differences(const RecordedMessage& a,
                                                     const RecordedMessage& b) const;

 private:
  const ComparisonRules& rules_;
};

}  // namespace armjig
