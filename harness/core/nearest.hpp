// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace armjig {

/// The letters that have to be changed, left out, put in or exchanged with their neighbour to make
/// one word of the other.
[[nodiscard]] std::size_t edit_distance(std::string_view one, std::string_view other);

/// The one of `names` that somebody who wrote `word` most likely meant, the first of several that
/// are equally near; empty if none is near enough, or `word` is one of them.
[[nodiscard]] std::string_view nearest(std::string_view word,
                                       std::span<const std::string_view> names);

/// For the beginning of a hint: `did you mean 'NAME'? `, or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       std::span<const std::string_view> names);

/// The same, where the names are what `name_of` says of each of `all`.
template <class All, class NameOf>
[[nodiscard]] std::string did_you_mean(std::string_view word, const All& all, NameOf name_of) {
  std::vector<std::string_view> names;
  for (const auto& one : all) names.push_back(std::invoke(name_of, one));
  return did_you_mean(word, names);
}

}  // namespace armjig
