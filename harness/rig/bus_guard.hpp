// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "harness/link/bus_port.hpp"
#include "harness/link/transaction_bus.hpp"
#include "harness/rig/guard.hpp"

namespace armjig {

/// `Judge` for the devices of a bus.
class BusJudge {
 public:
  BusJudge() = default;
  BusJudge(const BusJudge&) = delete;
  BusJudge& operator=(const BusJudge&) = delete;
  virtual ~BusJudge() = default;

  /// Judges a message that is about to be sent. None: it may be, and the judge takes it that it is.
  [[nodiscard]] virtual std::optional<Refusal> judge(const BusMessage& message,
                                                     const Permissions& permissions) = 0;

  /// Who may be moving because of what was sent.
  [[nodiscard]] virtual std::vector<BusAddress> moving() const = 0;

  /// What stops one of them. Harmless, whatever the permissions.
  [[nodiscard]] virtual Bytes stop_bytes() const = 0;
};

/// A device that this room knows.
struct BusJudgeEntry {
  std::string_view device;
  std::unique_ptr<BusJudge> (*make)();
};

/// All of them, by name.
[[nodiscard]] std::span<const BusJudgeEntry> bus_judges() noexcept;

/// Stands before every transaction on a bus that is not emulated. One that is refused fails with
/// `kForbidden`, nothing of it is sent, and what may be moving is stopped; so it is by the
/// destructor. There is no supervisor process: a motor that is told to turn goes on turning if this
/// process is killed (docs/limits.md).
class GuardedBus final : public TransactionBus {
 public:
  /// Requires both.
  GuardedBus(std::unique_ptr<BusPort> port, std::unique_ptr<BusJudge> judge,
             Permissions permissions);
  ~GuardedBus() override;

  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override;
  void wait_until(Instant time) override { port_->wait_until(time); }
  [[nodiscard]] Instant now() const override { return port_->now(); }

  /// Why it last refused something; none if it never did.
  [[nodiscard]] const std::optional<Refusal>& last_refusal() const noexcept { return refusal_; }

 private:
  void stop_all();

  std::unique_ptr<BusPort> port_;
  std::unique_ptr<BusJudge> judge_;
  Permissions permissions_;
  std::optional<Refusal> refusal_;
};

}  // namespace armjig
