// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/link/descriptor.hpp"

namespace armjig {

/// A second process that holds the same port and stops the arm when we can no longer do it: a
/// PAROL6 jogs for ever after the last command, so a program that is killed would leave it running.
///
/// The supervisor hears from us through a pipe. When the pipe ends without a farewell, because we
/// died however suddenly, or when it stays silent for half a second although the arm may be moving,
/// it writes the stop to the port until the arm stands. It ignores Ctrl-C, which reaches the whole
/// terminal at once.
class Supervisor {
 public:
  /// Starts the process. `port` stays open in it; `stop` is what it writes then. Call it while the
  /// program has one thread, for it forks. Errors: `kSystem` with the errno.
  [[nodiscard]] static Result<Supervisor> start(int port, std::vector<std::byte> stop);

  Supervisor(Supervisor&&) noexcept = default;
  Supervisor& operator=(Supervisor&&) noexcept = default;
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;
  /// Says farewell and waits for the process to end.
  ~Supervisor();

  /// The arm may be moving from now on, or (again) stands. Call it with every write while it may
  /// move: it is also the sign of life. False: the supervisor has stopped the arm and is gone.
  [[nodiscard]] bool tell(bool may_be_moving) noexcept;

 private:
  Supervisor(Descriptor pipe, int process) noexcept;

  Descriptor pipe_;
  int process_ = -1;
};

}  // namespace armjig
