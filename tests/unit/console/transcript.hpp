// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "harness/console/device_console.hpp"

namespace armjig {

/// What a console says, a line each; in front of it stands `*` for an event, `!` for what failed
/// and `?` for what could not be read.
class Transcript {
 public:
  [[nodiscard]] Say say() {
    return [this](Tone tone, std::string_view text) {
      constexpr std::string_view kMarks[] = {"", "* ", "! ", "? "};
      text_ += kMarks[static_cast<std::size_t>(tone)];
      text_ += text;
      text_ += '\n';
    };
  }

  [[nodiscard]] std::string take() { return std::exchange(text_, {}); }

  /// What is said from the beginning of a command to its end, an hour later at the latest.
  [[nodiscard]] std::string run(DeviceConsole& console, std::string_view line) {
    text_.clear();
    console.begin(line);
    for (const auto end = console.now() + std::chrono::hours{1}; console.is_busy();) {
      if (!console.cycle() || console.now() > end) return take() + "AND DID NOT END";
    }
    return take();
  }

 private:
  std::string text_;
};

}  // namespace armjig
