// SPDX-License-Identifier: Apache-2.0
#include "cli/settings.hpp"

#include <fmt/core.h>

#include <utility>

namespace armjig::cli {

Outcome<DeviceOptions> parse_settings(const std::vector<std::string>& settings) {
  DeviceOptions options;
  for (const auto& setting : settings) {
    const auto equals = setting.find('=');
    if (equals == 0 || equals == std::string::npos) {
      return problem(ErrorCode::kBadValue, "--set " + setting, "write NAME=VALUE");
    }
    auto name = setting.substr(0, equals);
    if (options.contains(name)) {
      return problem(ErrorCode::kBadValue, "--set " + setting, "it is said twice");
    }
    options[std::move(name)] = setting.substr(equals + 1);
  }
  return options;
}

std::string target_of(const DeviceOptions& settings) {
  std::string text{"emulated:"};
  for (const auto& [name, value] : settings) {
    text += fmt::format("{}{}={}", text.ends_with(':') ? '?' : '&', name, value);
  }
  return text;
}

}  // namespace armjig::cli
