// SPDX-License-Identifier: Apache-2.0
#include "conformance/suite.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace armjig {

std::string name_of(const Case& one) {
  if (one.variant.empty()) return std::string{one.requirement};
  return fmt::format("{}.{}", one.requirement, one.variant);
}

const Requirement* find_requirement(const Suite& suite, std::string_view id) noexcept {
  for (const auto& chapter : suite.chapters) {
    const auto found = std::ranges::find(chapter.requirements, id, &Requirement::id);
    if (found != chapter.requirements.end()) return &*found;
  }
  return nullptr;
}

const Requirement& requirement_of(const Suite& suite, const Case& one) noexcept {
  return *find_requirement(suite, one.requirement);
}

}  // namespace armjig
