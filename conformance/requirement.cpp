// SPDX-License-Identifier: Apache-2.0
#include "conformance/requirement.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

#include "conformance/shipped_documents.hpp"

namespace armjig {

std::string_view to_string(Role role) noexcept { return role == Role::kDevice ? "device" : "host"; }

std::string_view to_string(Profile profile) noexcept {
  return profile == Profile::kFirmware ? "firmware" : "documented";
}

std::string_view to_string(Profiles profiles) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"both", "firmware", "documented"};
  return kNames[static_cast<std::size_t>(profiles)];
}

Document shipped_document(std::string_view path) noexcept {
  const auto documents = shipped_documents();
  const auto found = std::ranges::find(documents, path, &Document::path);
  assert(found != documents.end());
  return *found;
}

ReportRow row_about(const Requirement& requirement, const Document& document) {
  ReportRow row;
  row.requirement = requirement.id;
  row.level = requirement.level;
  row.demand = requirement.text;
  row.source = requirement.source;
  row.document = document.path;
  const auto place = std::ranges::find(document.lines, requirement.id, &DocumentLine::requirement);
  if (place != document.lines.end()) row.line = place->line;
  return row;
}

}  // namespace armjig
