// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/link/descriptor.hpp"

namespace armjig {

/// A second process that holds the same port and stops the arm when we can no longer do it: a
/// PAROL6 jogs for ever after the last command, so a program that is killed would leave it running.
///
/// The supervisor hears from us through a socket. When that ends while the arm may be moving,
/// because we died however suddenly, or when it stays silent for half a second then, it writes the
/// stop to the port for a second, then ends. It has a session and a name of its own, so that
/// neither Ctrl-C and Ctrl-Z nor `killall armjig` reach it, and keeps no other file open.
class Supervisor {
 public:
  /// The longest stop.
  static constexpr std::size_t kMostStopBytes = 1024;

  enum class Motion : char {
    kNone = 's',
    kPossible = 'm',
  };

  /// Starts the process and waits until it watches. `port` stays open in it; `stop` is what it
  /// writes then, and requires `stop.size() <= kMostStopBytes`. Call it while the program has one
  /// thread, for it forks. Errors: `kSystem` with the errno.
  [[nodiscard]] static Result<Supervisor> start(int port, Bytes stop);

  Supervisor(Supervisor&& other) noexcept;
  Supervisor& operator=(Supervisor&& other) noexcept;
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;
  /// Waits for the process to end: at once if the arm was last said to stand, else behind a second
  /// of stops.
  ~Supervisor();

  /// Say that motion is possible before each write that may cause it, or may follow one that did:
  /// it is also the sign of life. Say that there is none only when the arm has shown that it
  /// stands. False: the supervisor is gone, and may have stopped the arm.
  [[nodiscard]] bool tell(Motion motion) noexcept;

  /// Another stop from now on, not longer than `kMostStopBytes`. False as for `tell`.
  [[nodiscard]] bool tell_stop(Bytes stop) noexcept;

 private:
  Supervisor(Descriptor socket, int process) noexcept;
  [[nodiscard]] bool is_ready() const noexcept;

  Descriptor socket_;
  int process_ = -1;
};

}  // namespace armjig
