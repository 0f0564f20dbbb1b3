// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "harness/core/error.hpp"
#include "harness/link/descriptor.hpp"
#include "harness/link/lifeline.hpp"
#include "harness/rig/judge.hpp"

namespace armjig {

/// What stops a device, without heap: messages, each after its size in two bytes.
class PackedStop {
 public:
  static constexpr std::size_t kMostBytes = 1024;

  PackedStop() = default;
  /// Requires that they fit in.
  explicit PackedStop(Messages messages) noexcept;
  [[nodiscard]] static PackedStop of(Bytes packed) noexcept;

  [[nodiscard]] Bytes bytes() const noexcept { return Bytes{bytes_}.first(size_); }
  void send(const Lifeline& line) const noexcept;

  friend bool operator==(const PackedStop&, const PackedStop&) = default;

 private:
  static constexpr std::size_t kPrefix = 2;
  std::array<std::byte, kMostBytes> bytes_{};
  std::size_t size_ = 0;
};

/// A second process that holds the same port and stops the arm when we can no longer do it: a
/// PAROL6 jogs for ever after the last command, so a program that is killed would leave it running.
///
/// The supervisor hears from us through a socket. When that ends while the arm may be moving,
/// because we died however suddenly, or when it stays silent for half a second then, it sends the
/// stop for a second, then ends. It has a session and a name of its own, so that
/// neither Ctrl-C and Ctrl-Z nor `killall armjig` reach it, and keeps no other file open.
class Supervisor {
 public:
  enum class Motion : char {
    kNone = 's',
    kPossible = 'm',
  };

  /// Starts the process and waits until it watches. The file of `line` stays open in it; `stop` is
  /// what it sends then. Call it while the program has one thread, for it forks. Errors: `kSystem`
  /// with the errno.
  [[nodiscard]] static Result<Supervisor> start(const Lifeline& line, Messages stop);

  Supervisor(Supervisor&& other) noexcept;
  Supervisor& operator=(Supervisor&& other) noexcept;
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;
  /// Waits for the process to end: at once if the arm was last said to stand, else after a second
  /// of stops.
  ~Supervisor();

  /// Say that motion is possible before each write that may cause it, or may follow one that did:
  /// it is also the sign of life. Say that there is none only when the arm has shown that it
  /// stands. False: the supervisor is gone, and may have stopped the arm.
  [[nodiscard]] bool tell(Motion motion) noexcept;

  /// Another stop from now on. False as for `tell`.
  [[nodiscard]] bool tell_stop(Messages stop) noexcept;

 private:
  Supervisor(Descriptor socket, int process, const PackedStop& told) noexcept;
  [[nodiscard]] bool is_ready() const noexcept;

  Descriptor socket_;
  int process_ = -1;
  PackedStop told_;
};

}  // namespace armjig
