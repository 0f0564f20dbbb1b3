// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <utility>

#include "harness/core/error.hpp"

namespace armjig {

/// The settings of a terminal as they were, which are put back in the end: when this goes, or when
/// SIGINT, SIGTERM or SIGHUP end a program that does not handle them itself.
class TerminalSettings {
 public:
  /// Requires that the file stays open as long. Errors: those of errno, and `kBusy` if too many
  /// terminals are kept at once.
  [[nodiscard]] static Result<TerminalSettings> keep(int terminal) noexcept;

  TerminalSettings(TerminalSettings&& other) noexcept : place_{std::exchange(other.place_, -1)} {}
  TerminalSettings& operator=(TerminalSettings&&) = delete;
  TerminalSettings(const TerminalSettings&) = delete;
  TerminalSettings& operator=(const TerminalSettings&) = delete;
  ~TerminalSettings();

 private:
  explicit TerminalSettings(int place) noexcept : place_{place} {}

  int place_;
};

/// The session that works on a terminal: a shell, a login. 0 if there is none, or this system does
/// not tell.
[[nodiscard]] pid_t session_on(int terminal);

/// `it is the terminal of process 123`.
[[nodiscard]] std::string describe_session(pid_t session);

}  // namespace armjig
