// SPDX-License-Identifier: Apache-2.0
#include "conformance/selection.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

#include "harness/core/number.hpp"

namespace armjig {
namespace {

bool is_meant(const Suite& suite, const Case& one, Profile profile, const Selection& selection) {
  return holds_in(requirement_of(suite, one).profiles, profile) &&
         (one.tier <= selection.tier || is_vital(suite, one)) &&
         name_of(one).find(selection.filter) != std::string::npos;
}

}  // namespace

Outcome<Shard> parse_shard(std::string_view text) {
  const auto slash = text.find('/');
  if (slash != std::string_view::npos) {
    const auto index = whole_text_as<std::size_t>(text.substr(0, slash));
    const auto count = whole_text_as<std::size_t>(text.substr(slash + 1));
    if (index && count && *index >= 1 && *index <= *count) return Shard{*index, *count};
  }
  return problem(ErrorCode::kBadValue, "--shard " + std::string{text},
                 "write which of how many, as in 1/4");
}

std::vector<const Case*> select(const Suite& suite, Profile profile, const Selection& selection) {
  std::vector<const Case*> cases;
  for (const auto& chapter : suite.chapters) {
    for (const auto& one : chapter.cases) {
      if (is_meant(suite, one, profile, selection)) cases.push_back(&one);
    }
  }
  std::ranges::stable_sort(cases, {}, [&](const Case* one) {
    return std::tuple{one->hazard == Hazard::kCrash, one->start, !is_vital(suite, *one)};
  });
  const auto border = [&](std::size_t shards) {
    return static_cast<std::ptrdiff_t>(cases.size() * shards / selection.shard.count);
  };
  return {cases.begin() + border(selection.shard.index - 1),
          cases.begin() + border(selection.shard.index)};
}

}  // namespace armjig
