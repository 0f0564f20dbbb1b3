// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace armjig {

/// All of the text as a number; nothing if it is none, or not one of that type. No blanks and no
/// `+`; `form` is as for `std::from_chars`.
template <class Number, class... Form>
[[nodiscard]] std::optional<Number> whole_text_as(std::string_view text, Form... form) noexcept {
  Number number{};
  const auto* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number, form...);
  return error == std::errc{} && stop == end ? std::optional{number} : std::nullopt;
}

}  // namespace armjig
