// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "harness/core/error.hpp"

/// The options of emulated devices: a table for each device, one engine for all.
namespace armjig {

/// `NAME=VALUE` pairs that describe an emulated device.
using DeviceOptions = std::map<std::string, std::string, std::less<>>;

/// Where the figure that an option has lies in real devices. `armjig shadow fit` looks for it
/// there.
struct FitRange {
  enum class Scale : std::uint8_t {
    kLinear,
    kRatio,  ///< twice as much is as far everywhere; `least` is above 0
  };
  double least{};
  double most{};   ///< not above `least`: the option is no figure
  double usual{};  ///< where the search begins
  Scale scale{};
  bool is_whole{};
  std::size_t count = 1;  ///< of a list
};

/// An option as help, documents and completion show it. `values` is both shown and obeyed:
///
///     a|b|c    one of these words
///     L..H     a number from L to H, either of which may be left out
///     NAME     any text but an empty one
///
/// with `,...` after it for a list of them with commas between.
struct OptionRow {
  std::string_view name;
  std::string_view values;
  std::string_view meaning;
  FitRange fit{};
};

/// What somebody wrote for an option. Problems are `kBadValue` at `WHERE, NAME=VALUE`.
class OptionValue {
 public:
  OptionValue(const OptionRow& row, std::string_view text, std::string_view where) noexcept
      : row_{row}, text_{text}, where_{where} {}

  /// The text as it is.
  Outcome<void> take(std::string& place) const;

  /// `meanings` of the row's words, in their order.
  template <class Place>
  Outcome<void> choose(Place& place,
                       std::initializer_list<std::type_identity_t<Place>> meanings) const {
    return index().map([&](std::size_t index) { place = meanings.begin()[index]; });
  }

  /// A number in the row's range, which is one of `Number`: whole for integers, finite in any case.
  template <std::integral Number>
  Outcome<void> take(Number& place) const {
    return whole(std::numeric_limits<Number>::max()).map([&](std::int64_t number) {
      place = static_cast<Number>(number);
    });
  }
  Outcome<void> take(double& place) const;
  Outcome<void> take(std::chrono::microseconds& place) const;

  /// Each value of the list to `take_one(OptionValue) -> Outcome<void>`, up to the first problem.
  template <class TakeOne>
  Outcome<void> each(TakeOne take_one) const {
    for (auto rest = text_;;) {
      const auto comma = rest.find(',');
      Outcome<void> taken = take_one(OptionValue{row_, rest.substr(0, comma), where_});
      if (!taken || comma == std::string_view::npos) return taken;
      rest.remove_prefix(comma + 1);
    }
  }

  /// The same with each value's text, `take_one(std::string_view) -> Outcome<void>`, as for `take`.
  template <class TakeOne>
  Outcome<void> take_each(TakeOne take_one) const {
    return each([&](const OptionValue& one) { return one.take(take_one(one.text())); });
  }

  /// What became of the text, with the hint of whoever refused it.
  [[nodiscard]] Outcome<void> take(const Outcome<void>& taken) const;

  [[nodiscard]] std::string_view text() const noexcept { return text_; }

 private:
  [[nodiscard]] tl::unexpected<Problem> refuse(std::string hint) const;
  [[nodiscard]] tl::unexpected<Problem> refuse_number(std::string_view kind) const;
  [[nodiscard]] Outcome<std::size_t> index() const;
  [[nodiscard]] Outcome<std::int64_t> whole(std::int64_t most) const;

  const OptionRow& row_;
  std::string_view text_;
  std::string_view where_;
};

/// A row of a device's table, and what its value does to the device's settings.
template <class Settings>
struct DeviceOption : OptionRow {
  Outcome<void> (*set)(Settings& settings, const OptionValue& value);
};

/// What users see of a table.
template <class Settings, std::size_t size>
[[nodiscard]] constexpr std::array<OptionRow, size> rows_of(
    const std::array<DeviceOption<Settings>, size>& table) noexcept {
  std::array<OptionRow, size> rows{};
  for (std::size_t i = 0; i < size; ++i) rows[i] = table[i];
  return rows;
}

/// Whether all options have one of the names. Problems: `kUnknownOption` at `WHERE, NAME`.
[[nodiscard]] Outcome<void> check_names(std::string_view device,
                                        const std::vector<std::string_view>& known,
                                        const DeviceOptions& options, std::string_view where);

/// `settings` with what `options` change, in the order of the table. `where` they came from is for
/// problems: `kUnknownOption`, `kBadValue`.
template <class Settings>
[[nodiscard]] Outcome<Settings> read_options(
    std::string_view device, std::type_identity_t<std::span<const DeviceOption<Settings>>> table,
    const DeviceOptions& options, std::string_view where, Settings settings) {
  std::vector<std::string_view> names;
  for (const auto& row : table) names.push_back(row.name);
  auto checked = check_names(device, names, options, where);
  for (const auto& row : table) {
    const auto option = options.find(row.name);
    if (!checked || option == options.end()) continue;
    checked = row.set(settings, OptionValue{row, option->second, where});
  }
  return checked.map([&] { return std::move(settings); });
}

/// The rows as a table in Markdown.
[[nodiscard]] std::string to_markdown(std::span<const OptionRow> rows);

/// A table of a file that describes devices, `[[kind]]`, with the keys below it as options.
struct OptionGroup {
  struct Key {
    std::string name;
    std::string value;
    std::string where;  ///< `FILE:LINE`
  };
  std::string kind;
  std::string where;
  std::vector<Key> keys;
};

template <class Content>
Outcome<Content> refuse_file(const std::string& path) {
  return problem(ErrorCode::kUnsupported, path, "this program reads no files");
}

/// What reads the files that options name, for devices, which do no I/O themselves. Problems name
/// the file, and the line if there is one.
struct OptionFiles {
  std::function<Outcome<std::string>(const std::string& path)> read_text = refuse_file<std::string>;
  std::function<Outcome<std::vector<OptionGroup>>(const std::string& path)> read_groups =
      refuse_file<std::vector<OptionGroup>>;
};

}  // namespace armjig
