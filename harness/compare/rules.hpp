// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/field.hpp"

namespace armjig {

/// What may differ between two recordings. Nothing, unless a file says it.
struct ComparisonRules {
  struct FieldRule {
    std::string message;  ///< the kind; empty: all that have the field
    std::string name;
    bool is_ignored = false;
    double tolerance = 0;  ///< in the unit of the field
  };

  Duration time_tolerance{};
  bool is_order_free = false;  ///< what only moved is equal
  std::vector<std::string> ignored_messages;
  std::vector<FieldRule> fields;

  /// From TOML; docs/captures.md has its keys. Problems: those of `TomlTable`.
  [[nodiscard]] static Outcome<ComparisonRules> read(const std::string& path);
  /// The same from text in memory; `path` is for messages.
  [[nodiscard]] static Outcome<ComparisonRules> parse(std::string_view text,
                                                      const std::string& path);

  /// Whether two values of a field count as one.
  [[nodiscard]] bool allows(std::string_view message, const Field& field, std::int64_t one,
                            std::int64_t other) const;
  [[nodiscard]] bool ignores(std::string_view message) const;
};

}  // namespace armjig
