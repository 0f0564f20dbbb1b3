// SPDX-License-Identifier: Apache-2.0
#include "harness/console/arguments.hpp"

#include <fmt/core.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <system_error>

#include "harness/core/number.hpp"

namespace armjig {

Parsed<Number> parse_number(std::string_view text) {
  const auto digits = text.substr(text.starts_with('+') ? 1 : 0);
  Number number;
  const auto* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, number.value);
  if (error != std::errc{} || !std::isfinite(number.value)) {
    return wrong(fmt::format("'{}' is not a number", text));
  }
  number.unit = {stop, end};
  return number;
}

Parsed<float> parse_float(std::string_view text) {
  const auto number = parse_number(text);
  const bool is_good = number && number->unit.empty() &&
                       std::abs(number->value) <= double{std::numeric_limits<float>::max()};
  if (is_good) return static_cast<float>(number->value);
  return wrong(fmt::format("'{}' is not a number", text));
}

Parsed<Duration> parse_seconds(std::string_view text) {
  const auto number = parse_number(text);
  if (!number) return tl::unexpected{number.error()};
  if (!number->unit.empty() && number->unit != "s") {
    return wrong(fmt::format("'{}' has an unknown unit: write seconds", text));
  }
  if (number->value <= 0 || number->value > 3600) {
    return wrong(fmt::format("'{}' is not a time: above 0, at most 3600 s", text));
  }
  return std::chrono::round<Duration>(std::chrono::duration<double>{number->value});
}

Parsed<std::int16_t> parse_whole(std::string_view what, std::string_view text, int least,
                                 int most) {
  const auto value = whole_text_as<std::int32_t>(text);
  if (value && *value >= least && *value <= most) return static_cast<std::int16_t>(*value);
  return wrong(fmt::format("'{}' is no {}: a whole number from {} to {}", text, what, least, most));
}

}  // namespace armjig
