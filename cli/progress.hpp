// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <fmt/core.h>

#include <cstdio>
#include <string_view>

namespace armjig::cli {

/// The last line of a terminal, on standard error, that says what is being waited for.
class Progress {
 public:
  Progress() : is_shown_{::isatty(STDERR_FILENO) == 1} {}

  void say(std::string_view what) const {
    constexpr std::size_t kRoom = 78;
    if (is_shown_) fmt::print(stderr, "\r{:<{}}\r", what.substr(0, kRoom), kRoom);
  }
  /// Before anything else is written.
  void clear() const { say({}); }

 private:
  bool is_shown_;
};

}  // namespace armjig::cli
