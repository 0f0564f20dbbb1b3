// SPDX-License-Identifier: Apache-2.0
#include "harness/core/nearest.hpp"

#include <algorithm>
#include <utility>

namespace armjig {

std::size_t edit_distance(std::string_view one, std::string_view other) {
  std::vector<std::size_t> before;  // the row above, and the one above that
  std::vector<std::size_t> above(other.size() + 1);
  for (std::size_t j = 0; j <= other.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= one.size(); ++i) {
    std::vector<std::size_t> row(other.size() + 1, i);
    for (std::size_t j = 1; j <= other.size(); ++j) {
      const std::size_t is_other = one[i - 1] == other[j - 1] ? 0 : 1;
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + is_other});
      const bool is_exchanged =
          i > 1 && j > 1 && one[i - 1] == other[j - 2] && one[i - 2] == other[j - 1];
      if (is_exchanged) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = std::exchange(above, std::move(row));
  }
  return above.back();
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> names) {
  constexpr std::size_t kLeastBeginning = 3;
  std::string_view best;
  // A third of the letters may be wrong, at least one, but never all.
  std::size_t least = std::min(std::max<std::size_t>(word.size() / 3, 1) + 1, word.size());
  for (const auto name : names) {
    if (name == word) return {};
    const bool is_beginning = word.size() >= kLeastBeginning && name.starts_with(word);
    const auto distance = is_beginning ? 1 : edit_distance(word, name);
    if (distance >= least) continue;
    least = distance;
    best = name;
  }
  return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> names) {
  const auto name = nearest(word, names);
  return name.empty() ? "" : "did you mean '" + std::string{name} + "'? ";
}

}  // namespace armjig
