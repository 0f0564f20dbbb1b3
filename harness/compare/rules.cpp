// SPDX-License-Identifier: Apache-2.0
#include "harness/compare/rules.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "harness/config/toml_table.hpp"

namespace armjig {
namespace {

/// The number of `key`, which may not be negative; 0 if it is not there.
double amount(TomlTable& table, std::string_view key) {
  constexpr double kMost = 1e12;
  const auto value = table.number(key).value_or(0);
  if (value >= 0 && value <= kMost) return value;
  table.complain(key, "write a number from 0 to 1e12");
  return 0;
}

/// The text of `key`, which has to be there.
std::string demanded(TomlTable& table, std::string_view key) {
  const auto value = table.text(key);
  if (!value || value->empty()) table.complain(key, "write a name, as armjig decode -v shows it");
  return value.value_or("");
}

Outcome<ComparisonRules> rules_of(TomlTable table) {
  ComparisonRules rules;
  rules.time_tolerance = std::chrono::duration_cast<Duration>(
      std::chrono::duration<double, std::milli>{amount(table, "time_ms")});
  const auto order = table.text("order").value_or("kept");
  if (order != "kept" && order != "free") table.complain("order", "write 'kept' or 'free'");
  rules.is_order_free = order == "free";
  for (auto& message : table.tables("message")) {
    const auto name = demanded(message, "name");
    if (!message.boolean("ignore").value_or(false)) {
      message.complain("ignore", "write ignore = true; nothing else can be said of a message");
    }
    rules.ignored_messages.push_back(name);
  }
  for (auto& field : table.tables("field")) {
    auto& rule = rules.fields.emplace_back();
    rule.name = demanded(field, "name");
    rule.message = field.text("message").value_or("");
    rule.is_ignored = field.boolean("ignore").value_or(false);
    rule.tolerance = amount(field, "tolerance");
    if (rule.is_ignored == (rule.tolerance > 0)) {
      field.complain("tolerance", "write either tolerance, more than 0, or ignore = true");
    }
  }
  if (auto finished = table.finish(); !finished) return tl::unexpected{finished.error()};
  return rules;
}

}  // namespace

Outcome<ComparisonRules> ComparisonRules::read(const std::string& path) {
  return TomlTable::read(path).and_then(rules_of);
}

Outcome<ComparisonRules> ComparisonRules::parse(std::string_view text, const std::string& path) {
  return TomlTable::parse(text, path).and_then(rules_of);
}

bool ComparisonRules::allows(std::string_view message, const Field& field, std::int64_t one,
                             std::int64_t other) const {
  if (one == other) return true;
  return std::ranges::any_of(fields, [&](const FieldRule& rule) {
    if (rule.name != field.name || (!rule.message.empty() && rule.message != message)) return false;
    return rule.is_ignored ||
           std::abs(number_of(field, one) - number_of(field, other)) <= rule.tolerance;
  });
}

bool ComparisonRules::ignores(std::string_view message) const {
  return std::ranges::find(ignored_messages, message) != ignored_messages.end();
}

}  // namespace armjig
