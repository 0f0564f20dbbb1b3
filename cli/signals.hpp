// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <csignal>

#include "cli/command.hpp"

namespace armjig::cli {

/// Turns the signals that would end the program into questions, so that it can leave a terminal and
/// an arm in good order first, and a report. Ctrl-Z does nothing meanwhile: a program that is
/// stopped sends no frames. One at a time.
class Signals {
 public:
  Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  ~Signals();

  /// Whether Ctrl-C (SIGINT) came since the last call.
  [[nodiscard]] bool take_interrupt() noexcept;
  /// Whether SIGTERM or SIGHUP came.
  [[nodiscard]] bool must_end() const noexcept;
  /// Whether any of them ever came. From any thread.
  [[nodiscard]] bool has_come() const noexcept;
  /// How a program ends that one of them has ended: 128 and the number of the last one.
  [[nodiscard]] Exit exit() const noexcept;

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGTSTP};

  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace armjig::cli
