// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <cstdlib>

#include "harness/core/bytes.hpp"

namespace armjig::fuzz {

/// Ends the program if a promise does not hold, which is what a fuzzer looks for.
inline void require(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", promise);
  std::abort();
}

/// As text, since the library compares bytes one by one, and sanitizers look at each.
inline bool are_equal(Bytes one, Bytes other) { return as_text(one) == as_text(other); }

}  // namespace armjig::fuzz
