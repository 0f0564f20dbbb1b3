// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "harness/link/descriptor.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/link/transaction_bus.hpp"

/// Real ports that are opened again when their device has gone: a cable pulled, a board reset, an
/// emulator restarted. Their time goes on without a jump. They have no lifeline, because their file
/// changes: who has to stop an arm through one (`GuardedStream`, `GuardedBus`) can not use them.
namespace armjig {

/// The port that is open at the moment, and how the next one is opened.
template <class Port>
class Reopener {
 public:
  using Open = std::function<Outcome<std::unique_ptr<Port>>()>;

  /// `port` is open; `open` makes the next one.
  Reopener(std::unique_ptr<Port> port, Open open) noexcept;

  /// None while the device is away.
  [[nodiscard]] Port* port() noexcept { return port_.get(); }
  [[nodiscard]] Instant now() const { return clock_.now(); }
  /// How often it was opened again.
  [[nodiscard]] std::uint64_t reopened() const noexcept { return reopened_; }

  /// Requires that the device is away. Tries to open it at once and then twice a second, and sleeps
  /// at most until `deadline`, so that whoever waits keeps its pace.
  void wait_for_device(Instant deadline);
  /// What a port failed with. Only a device that has gone may come back: other errors remain.
  [[nodiscard]] Result<void> lose(const Error& error);

 private:
  std::unique_ptr<Port> port_;
  Open open_;
  Stopwatch clock_;
  Instant next_try_{};
  std::uint64_t reopened_ = 0;
};

extern template class Reopener<StreamPort>;
extern template class Reopener<BusPort>;

/// While the device is away, what is written is lost and nothing comes; who reads waits for it.
class ReopeningStream final : public StreamPort {
 public:
  using Open = Reopener<StreamPort>::Open;

  ReopeningStream(std::unique_ptr<StreamPort> port, Open open) noexcept
      : device_{std::move(port), std::move(open)} {}

  Result<void> write(Bytes bytes) override;
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override;
  [[nodiscard]] Instant now() const override { return device_.now(); }
  [[nodiscard]] std::uint64_t reopened() const noexcept { return device_.reopened(); }

 private:
  Reopener<StreamPort> device_;
};

/// While the adapter is away, transactions fail with `kNotFound`; `wait_until` waits for it, too.
class ReopeningBus final : public TransactionBus {
 public:
  using Open = Reopener<BusPort>::Open;

  ReopeningBus(std::unique_ptr<BusPort> port, Open open) noexcept
      : adapter_{std::move(port), std::move(open)} {}

  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override;
  void wait_until(Instant time) override;
  [[nodiscard]] Instant now() const override { return adapter_.now(); }
  [[nodiscard]] std::uint64_t reopened() const noexcept { return adapter_.reopened(); }

 private:
  Reopener<BusPort> adapter_;
};

}  // namespace armjig
