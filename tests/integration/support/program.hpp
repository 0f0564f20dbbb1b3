// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

#include "harness/link/descriptor.hpp"

namespace armjig::testing {

/// Long enough for the slowest machine with sanitizers; only a failure takes that long.
inline constexpr std::chrono::seconds kPatience{30};

/// The armjig program as a child process, killed with its owner if it still runs.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments);
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();

  /// The next line of standard output without its end; what there is when output ends or patience.
  [[nodiscard]] std::string read_line();

  /// All that is left of standard error, until it ends.
  [[nodiscard]] std::string read_errors();

  void signal(int number) const;

  /// Waits for its end. The exit code, or minus the signal that ended it.
  [[nodiscard]] int wait();

  [[nodiscard]] pid_t pid() const noexcept { return pid_; }

 private:
  pid_t pid_ = -1;
  Descriptor output_;
  Descriptor errors_;
};

/// Memory of a process, in KiB; 0 if there is none.
[[nodiscard]] long resident_kib(pid_t pid);

/// How a run ended.
struct Ended {
  int exit_code{};
  std::string errors;
};

/// Runs the program to its end.
[[nodiscard]] Ended run_armjig(std::vector<std::string> arguments);

}  // namespace armjig::testing
