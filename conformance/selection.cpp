// SPDX-License-Identifier: Apache-2.0
#include "conformance/selection.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>

namespace armjig {
namespace {

std::optional<std::size_t> parse_count(std::string_view text) noexcept {
  std::size_t value{};
  const auto* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end ? std::optional{value} : std::nullopt;
}

bool is_meant(const Suite& suite, const Case& one, Profile profile, const Selection& selection) {
  return holds_in(requirement_of(suite, one).profiles, profile) && one.tier <= selection.tier &&
         name_of(one).find(selection.filter) != std::string::npos;
}

}  // namespace

Outcome<Shard> parse_shard(std::string_view text) {
  const auto slash = text.find('/');
  if (slash != std::string_view::npos) {
    const auto index = parse_count(text.substr(0, slash));
    const auto count = parse_count(text.substr(slash + 1));
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
  std::ranges::stable_sort(cases, {}, &Case::start);
  const auto border = [&](std::size_t shards) {
    return static_cast<std::ptrdiff_t>(cases.size() * shards / selection.shard.count);
  };
  return {cases.begin() + border(selection.shard.index - 1),
          cases.begin() + border(selection.shard.index)};
}

}  // namespace armjig
