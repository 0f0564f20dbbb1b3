// SPDX-License-Identifier: Apache-2.0
#include "conformance/requirement.hpp"

#include <array>
#include <cstddef>

namespace armjig {

std::string_view to_string(Role role) noexcept { return role == Role::kDevice ? "device" : "host"; }

std::string_view to_string(Profile profile) noexcept {
  return profile == Profile::kFirmware ? "firmware" : "documented";
}

std::string_view to_string(Profiles profiles) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"both", "firmware", "documented"};
  return kNames[static_cast<std::size_t>(profiles)];
}

ReportRow row_about(const Requirement& requirement) {
  ReportRow row;
  row.requirement = requirement.id;
  row.level = requirement.level;
  row.demand = requirement.text;
  row.source = requirement.source;
  return row;
}

}  // namespace armjig
