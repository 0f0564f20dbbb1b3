// SPDX-License-Identifier: Apache-2.0
#include "conformance/suite.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace armjig {

std::string name_of(const Case& one) {
  if (one.variant.empty()) return std::string{one.requirement};
  return fmt::format("{}.{}", one.requirement, one.variant);
}

Chapter chapter(std::string_view title, std::span<const Clause> clauses) {
  Chapter chapter{title, {}, {}};
  for (const auto& clause : clauses) {
    if (!clause.requirement.id.empty()) {
      chapter.requirements.push_back(clause.requirement);
    } else {
      auto& one = chapter.cases.emplace_back(clause.one);
      one.requirement = chapter.requirements.back().id;
      if (one.rule.empty()) one.rule = chapter.requirements.back().text;
    }
  }
  return chapter;
}

Chapter chapter(std::string_view title, std::span<const Requirement> requirements) {
  return {title, {requirements.begin(), requirements.end()}, {}};
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
