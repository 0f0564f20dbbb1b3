// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "harness/link/byte_queue.hpp"
#include "harness/link/port_around.hpp"
#include "harness/link/transaction_bus.hpp"
#include "harness/rig/guard.hpp"

/// A guard around each kind of port. All require a port, and a judge that knows the device.
namespace armjig {

/// What arrived while nobody read; then the oldest goes.
inline constexpr std::size_t kMostUnread = std::size_t{64} * 1024;

/// How a port that is open already gets its guard.
template <class Guarded, class Port>
class GuardedBy {
 public:
  /// Errors and threads: as for `Guard::begin`.
  [[nodiscard]] static Result<std::unique_ptr<Guarded>> guard(
      std::unique_ptr<Port> port, std::unique_ptr<Judge> judge, Permissions permissions,
      std::shared_ptr<GuardState> watch = std::make_shared<GuardState>()) {
    std::unique_ptr<Guarded> guarded{
        new Guarded{std::move(port), std::move(judge), permissions, std::move(watch)}};
    if (auto done = guarded->begin(guarded->lifeline()); !done) {
      return tl::unexpected{done.error()};
    }
    return guarded;
  }
};

class GuardedStream final : public StreamAround,
                            public Guard,
                            public GuardedBy<GuardedStream, StreamPort> {
 public:
  ~GuardedStream() override { stop_if_moving(); }

  Result<void> write(Bytes bytes) override { return send_guarded(bytes); }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override;

 private:
  friend GuardedBy<GuardedStream, StreamPort>;
  GuardedStream(std::unique_ptr<StreamPort> port, std::unique_ptr<Judge> judge,
                Permissions permissions, std::shared_ptr<GuardState> watch);
  Result<void> put(Bytes message) override { return inner().write(message); }
  Result<void> listen(Instant deadline) override;
  [[nodiscard]] Instant time() const override { return now(); }

  ByteQueue unread_;
};

/// Each connection has a supervisor of its own.
class GuardedSession final : public SessionAround, public Guard {
 public:
  GuardedSession(std::unique_ptr<SessionPort> port, std::unique_ptr<Judge> judge,
                 Permissions permissions,
                 std::shared_ptr<GuardState> watch = std::make_shared<GuardState>());
  ~GuardedSession() override;

  /// Errors and threads: as for `Guard::begin`.
  Result<void> connect(Instant deadline) override;
  Result<void> send(Bytes segment) override;
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override;
  void half_close() override;
  void close() override;
  void reset() override;

  using Guard::stop;

 private:
  Result<void> put(Bytes message) override { return inner().send(message); }
  Result<void> listen(Instant deadline) override;
  Result<void> settle(Instant deadline) override;
  [[nodiscard]] Instant time() const override { return now(); }
  void leave(WhenLeft when_left);
  void leave_for_good(WhenLeft when_left);

  bool is_open_ = false;
  ByteQueue unread_;
  std::optional<Received> unread_end_;
};

/// Passes whole transactions only, for of single operations nobody knows what they will become.
class GuardedBus final : public TransactionBus,
                         public Guard,
                         public GuardedBy<GuardedBus, BusPort> {
 public:
  ~GuardedBus() override { stop_if_moving(); }

  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override;
  /// Gives signs of life meanwhile.
  void wait_until(Instant time) override;
  [[nodiscard]] Instant now() const override { return port_->now(); }
  [[nodiscard]] std::optional<Lifeline> lifeline() const override { return port_->lifeline(); }

 private:
  friend GuardedBy<GuardedBus, BusPort>;
  GuardedBus(std::unique_ptr<BusPort> port, std::unique_ptr<Judge> judge, Permissions permissions,
             std::shared_ptr<GuardState> watch);
  Result<void> put(Bytes message) override;
  Result<void> listen(Instant deadline) override;
  [[nodiscard]] Instant time() const override { return now(); }

  std::unique_ptr<BusPort> port_;
};

/// Every connection to a server guarded. Also while nobody reads, the supervisors hear from us. It
/// outlives them.
class GuardedSource final : public SourceAround {
 public:
  GuardedSource(std::unique_ptr<SessionSource> inner, std::unique_ptr<Judge> (*make_judge)(),
                Permissions permissions, const std::shared_ptr<GuardState>& watch);
  ~GuardedSource() override;
  void pause(Duration duration) override;

 private:
  std::unique_ptr<Judge> (*make_judge_)();
  std::shared_ptr<GuardState> watch_;
};

}  // namespace armjig
