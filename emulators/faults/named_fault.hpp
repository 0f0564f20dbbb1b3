// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace armjig {

/// A fault as an `emulated:` target takes it, and the section of docs/spec that it is about.
struct NamedFault {
  std::string name;
  std::string section;
};

/// A word of such a name, and what it stands for.
template <class Meaning>
struct Named {
  std::string_view name;
  Meaning meaning;
};

/// nullptr: nothing in the table has that name.
template <class Table>
[[nodiscard]] constexpr auto* find_named(const Table& table, std::string_view name) {
  const auto found = std::ranges::find(table, name, [](const auto& one) { return one.name; });
  return found == table.end() ? nullptr : &*found;
}

/// Puts what the table has by that name, or rather where it stands, at the end of `chosen`. False:
/// nothing has it.
template <class Table, class Chosen>
[[nodiscard]] bool choose_named(const Table& table, std::string_view name, Chosen& chosen) {
  const auto* const found = find_named(table, name);
  if (found != nullptr) chosen.push_back(found);
  return found != nullptr;
}

/// What stands in front of the first `mark`, which is taken away with it.
[[nodiscard]] constexpr std::string_view take_until(std::string_view& text, char mark) {
  const auto place = text.find(mark);
  const auto head = text.substr(0, place);
  text.remove_prefix(place == std::string_view::npos ? text.size() : place + 1);
  return head;
}

}  // namespace armjig
