// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/hex.hpp"

/// Bytes for tests, as people write them.
namespace armjig::test {

using ByteVector = std::vector<std::byte>;

/// Bytes written as in the documents: `FF FF FF 34`.
[[nodiscard]] inline ByteVector hex(std::string_view text) {
  auto bytes = from_hex(text);
  if (!bytes) ADD_FAILURE() << "not hexadecimal: " << text;
  return bytes ? *bytes : ByteVector{};
}

[[nodiscard]] inline ByteVector zeros(std::size_t count) { return ByteVector(count); }

/// One behind the other.
template <class... More>
[[nodiscard]] ByteVector joined(ByteVector first, const More&... more) {
  (first.insert(first.end(), more.begin(), more.end()), ...);
  return first;
}

/// For `EXPECT_TRUE`: shows both as people write them if they differ.
[[nodiscard]] inline testing::AssertionResult same_bytes(Bytes actual, Bytes expected) {
  if (std::ranges::equal(actual, expected)) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << "\n  expected " << to_hex_dump(expected) << "\n  actual   " << to_hex_dump(actual);
}

[[nodiscard]] inline ByteVector as_vector(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

/// Numbers that are the same on every machine and in every run.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_{seed} {}

  /// From `least` to `most`, both included.
  [[nodiscard]] std::int64_t between(std::int64_t least, std::int64_t most) {
    const auto choices = static_cast<std::uint64_t>(most - least) + 1;
    return least + static_cast<std::int64_t>(engine_() % choices);
  }
  [[nodiscard]] bool one_in(std::int64_t chances) { return between(1, chances) == 1; }
  [[nodiscard]] std::byte byte() { return static_cast<std::byte>(between(0, 255)); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace armjig::test
