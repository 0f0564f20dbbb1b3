// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string_view>

namespace armjig::cli {

/// What the environment says under that name; empty if nothing. It ends with a zero.
[[nodiscard]] inline std::string_view environment(const char* name) noexcept {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): one thread, and nobody sets it
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string_view{} : std::string_view{value};
}

}  // namespace armjig::cli
