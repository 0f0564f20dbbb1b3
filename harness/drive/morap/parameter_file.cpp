// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/morap/parameter_file.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "harness/config/toml_table.hpp"

namespace armjig::morap::drive {
namespace {

ControllerKind read_kind(TomlTable& table) {
  const auto text = table.text("controller").value_or("");
  if (text == "speed") return ControllerKind::kSpeed;
  if (text != "position") {
    table.complain("controller", "say controller = \"position\" or controller = \"speed\"");
  }
  return ControllerKind::kPosition;
}

Coefficients read_filter(TomlTable& table, const char* name) {
  Coefficients filter;
  const auto values = table.numbers(name);
  if (!values || values->empty() || values->size() > kMostCoefficients) {
    table.complain(name,
                   fmt::format("{} has to be a list of 1 to {} numbers", name, kMostCoefficients));
    return filter;
  }
  for (const auto value : *values) {
    filter.values[filter.count++] = static_cast<float>(value);
  }
  return filter;
}

Outcome<ControllerSet> read_set(Outcome<TomlTable> table) {
  if (!table) return tl::unexpected{table.error()};
  ControllerSet set;
  set.kind = read_kind(*table);
  const auto rate = table->integer("rate_hz", 1, 65535);
  if (!rate) table->complain("rate_hz", "rate_hz is missing");
  set.rate_hz = static_cast<std::uint16_t>(rate.value_or(0));
  set.d = read_filter(*table, "d");
  set.c = read_filter(*table, "c");
  set.f = read_filter(*table, "f");
  set.integral = static_cast<float>(table->number("integral").value_or(0.0));
  if (const auto finished = table->finish(); !finished) return tl::unexpected{finished.error()};
  return set;
}

/// TOML wants a point or an exponent, so that it is no integer.
std::string to_text(float value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0F ? "inf" : "-inf";
  auto text = fmt::format("{:.9g}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string to_line(const char* name, const Coefficients& filter) {
  std::string list;
  for (std::size_t i = 0; i < filter.count; ++i) {
    list += (i == 0 ? "" : ", ") + to_text(filter.values[i]);
  }
  return fmt::format("{} = [{}]\n", name, list);
}

}  // namespace

Outcome<ControllerSet> read_parameters(const std::string& path) {
  return read_set(TomlTable::read(path));
}

Outcome<ControllerSet> parse_parameters(std::string_view text, std::string path) {
  return read_set(TomlTable::parse(text, std::move(path)));
}

std::string to_toml(const ControllerSet& set) {
  return fmt::format("controller = \"{}\"\nrate_hz = {}\n",
                     set.kind == ControllerKind::kSpeed ? "speed" : "position", set.rate_hz) +
         to_line("d", set.d) + to_line("c", set.c) + to_line("f", set.f) +
         fmt::format("integral = {}\n", to_text(set.integral));
}

}  // namespace armjig::morap::drive
