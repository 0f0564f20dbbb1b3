// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "harness/core/time.hpp"

/// What people type behind a command. What cannot be read is told in a sentence.
namespace armjig {

template <class T>
using Parsed = tl::expected<T, std::string>;

[[nodiscard]] inline auto wrong(std::string sentence) {
  return tl::unexpected{std::move(sentence)};
}

struct Number {
  double value{};         ///< finite
  std::string_view unit;  ///< what follows it
};
[[nodiscard]] Parsed<Number> parse_number(std::string_view text);

/// A number without a unit that single precision has.
[[nodiscard]] Parsed<float> parse_float(std::string_view text);

/// `1.5` or `1.5s`: above 0, at most an hour.
[[nodiscard]] Parsed<Duration> parse_seconds(std::string_view text);

/// A whole number in a range; `what` is named in the sentence.
[[nodiscard]] Parsed<std::int16_t> parse_whole(std::string_view what, std::string_view text,
                                               int least, int most);

}  // namespace armjig
