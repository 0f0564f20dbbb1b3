// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/link/bus_port.hpp"
#include "harness/link/descriptor.hpp"

namespace armjig {

/// A bus that does whole transactions only.
class TransactionBus : public BusPort {
 public:
  [[nodiscard]] bool has_operations() const noexcept final { return false; }
  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override = 0;
  Result<Ack> start(BusAddress /*address*/, Access /*access*/) final {
    return fail(ErrorCode::kUnsupported);
  }
  Result<Ack> write(std::byte /*byte*/) final { return fail(ErrorCode::kUnsupported); }
  Result<std::byte> read(Ack /*reply*/) final { return fail(ErrorCode::kUnsupported); }
  Result<void> stop() final { return fail(ErrorCode::kUnsupported); }
};

/// One on monotonic time.
class RealBus : public TransactionBus {
 public:
  void wait_until(Instant time) final;
  [[nodiscard]] Instant now() const final { return clock_.now(); }

 protected:
  /// Whether a transaction has messages, and neither too many nor too long ones.
  [[nodiscard]] static bool can_do(std::span<const BusMessage> messages, std::size_t most,
                                   std::size_t longest) noexcept;

 private:
  Stopwatch clock_;
};

}  // namespace armjig
