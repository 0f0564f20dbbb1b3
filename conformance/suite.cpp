// SPDX-License-Identifier: Apache-2.0
#include "conformance/suite.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace armjig {

std::string name_of(const Case& one) {
  if (one.variant.empty()) return std::string{one.requirement};
  return fmt::format("{}.{}", one.requirement, one.variant);
}

/// FNV-1a.
std::uint64_t seed_of(const Case& one, std::uint64_t seed) {
  auto hash = 0xCBF29CE484222325ULL ^ seed;
  for (const auto letter : name_of(one)) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001B3ULL;
  }
  return hash;
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

const Requirement* find_requirement_about(const Suite& suite, std::string_view message,
                                          std::string_view aspect) noexcept {
  const auto speaks = [&](const Subject& subject) {
    const auto name = subject.aspect;
    const bool is_of_it =
        aspect.starts_with(name) && (aspect.size() == name.size() || aspect[name.size()] == '.');
    return is_of_it && (subject.message.empty() || subject.message == message);
  };
  const auto precision = [](const Subject& subject) {
    return std::pair{!subject.message.empty(), subject.aspect.size()};
  };
  const Subject* best = nullptr;
  for (const auto& subject : suite.subjects) {
    if (speaks(subject) && (best == nullptr || precision(subject) > precision(*best))) {
      best = &subject;
    }
  }
  return best == nullptr ? nullptr : find_requirement(suite, best->requirement);
}

const Requirement& requirement_of(const Suite& suite, const Case& one) noexcept {
  return *find_requirement(suite, one.requirement);
}

bool is_vital(const Suite& suite, const Case& one) {
  return std::ranges::any_of(suite.vital, [name = name_of(one)](std::string_view piece) {
    return name.find(piece) != std::string::npos;
  });
}

}  // namespace armjig
