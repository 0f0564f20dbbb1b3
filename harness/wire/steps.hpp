// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/bytes.hpp"

namespace armjig {

/// Gives all of `bytes` to `cutter`, which finds messages in a stream, and each of its steps to
/// `take`. What a step points to is valid until `take` returns.
template <class Cutter, class Take>
constexpr void for_each_step(Cutter& cutter, Bytes bytes, Take take) {
  while (!bytes.empty()) {
    const auto step = cutter.step(bytes);
    bytes = bytes.subspan(step.used);
    take(step);
  }
}

}  // namespace armjig
