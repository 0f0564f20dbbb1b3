// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// What the whole test program takes from the heap by `new`. Counted by this program's own operator
/// new, on all threads.
namespace armjig::test {

[[nodiscard]] std::uint64_t allocations() noexcept;
[[nodiscard]] std::size_t bytes_in_use() noexcept;

}  // namespace armjig::test
