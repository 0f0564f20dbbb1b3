// SPDX-License-Identifier: Apache-2.0
#include "cli/checks.hpp"

#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "harness/core/number.hpp"

namespace armjig::cli {
namespace {

/// A whole number of either sign.
struct Whole {
  bool is_negative{};
  std::uint64_t size{};
};

std::optional<Whole> parse_whole(std::string_view text) {
  const bool is_negative = text.starts_with('-');
  if (is_negative || text.starts_with('+')) text.remove_prefix(1);
  const bool is_hexadecimal = text.starts_with("0x") || text.starts_with("0X");
  const auto size =
      whole_text_as<std::uint64_t>(text.substr(is_hexadecimal ? 2 : 0), is_hexadecimal ? 16 : 10);
  if (!size) return std::nullopt;
  return Whole{is_negative && *size > 0, *size};
}

/// `least` is small, as limits are.
bool is_within(const Whole& number, std::int64_t least, std::uint64_t most) {
  if (number.is_negative) return least < 0 && number.size <= static_cast<std::uint64_t>(-least);
  return number.size <= most && (least < 0 || number.size >= static_cast<std::uint64_t>(least));
}

const CLI::Validator kNotEmpty{
    [](std::string& text) { return std::string{text.empty() ? "its value is empty" : ""}; }, ""};

}  // namespace

CLI::Validator whole(std::int64_t least, std::uint64_t most) {
  return {[least, most](std::string& text) -> std::string {
            const auto number = parse_whole(text);
            if (!number || !is_within(*number, least, most)) {
              return fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
            }
            text = fmt::format("{}{}", number->is_negative ? "-" : "", number->size);
            return {};
          },
          fmt::format("{} to {}", least, most)};
}

CLI::Validator number(double least, double most) {
  return {[least, most](std::string& text) -> std::string {
            const auto value =
                whole_text_as<double>(std::string_view{text}.substr(text.starts_with('+') ? 1 : 0));
            if (value && *value >= least && *value <= most) return {};
            return fmt::format("'{}' is not a number from {} to {}", text, least, most);
          },
          fmt::format("{} to {}", least, most)};
}

void refuse_empty_texts(CLI::App& command) {
  for (auto* option : command.get_options()) {
    const bool takes_values = option->get_type_size_max() > 0;
    if (takes_values && option->get_name() != "PROGRAM") option->check(kNotEmpty);
  }
  for (auto* inner : command.get_subcommands([](const CLI::App*) { return true; })) {
    refuse_empty_texts(*inner);
  }
}

}  // namespace armjig::cli
