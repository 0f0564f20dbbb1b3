// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <termios.h>

#include <optional>
#include <string_view>

namespace armjig::cli {

/// Whether a person looks at standard output, on a terminal that can do more than print.
[[nodiscard]] bool has_screen();

/// A page that is drawn again and again in place, on the terminal's other screen, so that what was
/// there before comes back at the end. Keys are read and not shown. Requires `has_screen`.
class Screen {
 public:
  Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  ~Screen();

  /// Shows as many lines of `text` as the terminal has room for, each cut off at its width; asks
  /// for the size anew each time. Requires plain characters.
  void draw(std::string_view text);

  /// Whether `q` was pressed.
  [[nodiscard]] bool wants_to_quit() const;

 private:
  std::optional<termios> before_;  ///< of standard input, if that is a terminal
};

}  // namespace armjig::cli
