// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/known.hpp"

#include <algorithm>

#include "harness/config/toml_table.hpp"

namespace armjig::campaign {
namespace {

/// Whether `text` is `pattern` with anything in place of each `*`.
bool is_like(std::string_view text, std::string_view pattern) {
  const auto star = pattern.find('*');
  if (star == pattern.npos) return text == pattern;
  const auto head = pattern.substr(0, star);
  if (!text.starts_with(head)) return false;
  const auto rest = pattern.substr(star + 1);
  for (text.remove_prefix(head.size());; text.remove_prefix(1)) {
    if (is_like(text, rest)) return true;
    if (text.empty()) return false;
  }
}

Outcome<Known> known_in(TomlTable table) {
  Known known;
  known.model = table.text("model").value_or("");
  for (auto& one : table.tables("known")) {
    auto& defect = known.defects.emplace_back();
    defect.symptom = one.text("symptom").value_or("");
    defect.why = one.text("why").value_or("");
    if (defect.symptom.empty()) one.complain("symptom", "write a symptom as a report has it");
    if (defect.why.empty()) one.complain("why", "write why it is known");
  }
  return table.finish().map([&] { return std::move(known); });
}

}  // namespace

Outcome<Known> Known::read(const std::string& path) {
  return TomlTable::read(path).and_then(known_in);
}

Outcome<Known> Known::parse(std::string_view text, const std::string& path) {
  return TomlTable::parse(text, path).and_then(known_in);
}

const KnownDefect* Known::find(const Symptom& symptom) const {
  const auto key = symptom.key();
  const auto found = std::ranges::find_if(
      defects, [&key](const KnownDefect& one) { return is_like(key, one.symptom); });
  return found == defects.end() ? nullptr : &*found;
}

}  // namespace armjig::campaign
