// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "harness/link/session_port.hpp"
#include "harness/rig/guard.hpp"
#include "harness/rig/supervisor.hpp"

namespace armjig {

/// `GuardedStream` for a server: stands before every write on its connections. Losing a client
/// stops no server's arm, so whatever ends a connection while the arm may be moving is preceded by
/// the stop; with permission to move, a supervisor process does the same when this one dies.
class GuardedSession final : public SessionPort {
 public:
  GuardedSession(std::unique_ptr<SessionPort> port, std::unique_ptr<Judge> judge,
                 Permissions permissions);
  ~GuardedSession() override;

  /// With permission to move, call it while the program has one thread. Errors: those of the port
  /// and of `Supervisor::start`.
  Result<void> connect(Instant deadline) override;
  /// Errors: those of the port, and `kForbidden`.
  Result<void> send(Bytes segment) override;
  /// While the arm may be moving, at least two calls a second of this or `send` are due, or the
  /// supervisor stops it.
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override;
  void half_close() override;
  void close() override;
  void reset() override;
  [[nodiscard]] Instant now() const override { return port_->now(); }
  [[nodiscard]] std::optional<int> descriptor() const override { return port_->descriptor(); }

  /// Why it last refused a write; none if it never did.
  [[nodiscard]] const std::optional<Refusal>& last_refusal() const noexcept { return refusal_; }

 private:
  [[nodiscard]] Result<void> watch_over();
  void report();
  void stop();
  void stop_if_moving();
  void end();

  std::unique_ptr<SessionPort> port_;
  std::unique_ptr<Judge> judge_;
  Permissions permissions_;
  std::optional<Supervisor> supervisor_;  ///< of the connection
  std::optional<Refusal> refusal_;
  bool is_open_ = false;
};

}  // namespace armjig
