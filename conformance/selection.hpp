// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "conformance/suite.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// One part of a suite that several jobs share: the `index`-th of `count`, from 1.
struct Shard {
  std::size_t index = 1;
  std::size_t count = 1;
};

/// Reads `i/n`, as in `2/4`. Problems: `kBadValue`.
[[nodiscard]] Outcome<Shard> parse_shard(std::string_view text);

/// Which cases are meant.
struct Selection {
  std::string filter{};  ///< a piece of the case's name; empty: all
  Tier tier = Tier::kFull;
  Shard shard{};

  [[nodiscard]] bool is_everything() const noexcept {
    return filter.empty() && tier == Tier::kFull && shard.count == 1;
  }
};

/// The cases of the profile that are meant, in the order in which they are best run: those with
/// the same start state together, of these first what safety rests on, and those last that end or
/// hang the device's program. Shards are stretches of that order; together they have every case
/// once.
[[nodiscard]] std::vector<const Case*> select(const Suite& suite, Profile profile,
                                              const Selection& selection);

}  // namespace armjig
