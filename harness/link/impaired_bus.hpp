// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "harness/link/bus_port.hpp"
#include "harness/link/impaired_path.hpp"

namespace armjig {

/// An I2C bus that is as bad as `Impairment` says, as far as a bus can be. Each byte on the wire is
/// a chunk, addresses included.
///
/// - `loss` out: the device misses the byte, so that nobody acknowledges it; after a missed address
///   it misses everything until the next start. `loss` in: the byte reads as 0xFF, as an idle line.
/// - `bit_errors`: in data bytes. An address with one is a missed address: it must not mean another
///   device.
/// - `delay`, `stall`, `bandwidth`: the bus waits, as for a device that stretches the clock.
/// - `disconnect`: from then on nobody is there.
class ImpairedBus final : public BusPort {
 public:
  /// Requires `inner`. Problems: `kUnsupported` for defects that a bus cannot have.
  [[nodiscard]] static Outcome<std::unique_ptr<ImpairedBus>> make(std::unique_ptr<BusPort> inner,
                                                                  const Impairment& impairment);

  [[nodiscard]] Result<Ack> start(BusAddress address, Access access) override;
  [[nodiscard]] Result<Ack> write(std::byte byte) override;
  [[nodiscard]] Result<std::byte> read(Ack reply) override;
  Result<void> stop() override;
  Result<void> recover() override { return inner_->recover(); }
  void wait_until(Instant time) override { inner_->wait_until(time); }
  [[nodiscard]] Instant now() const override { return inner_->now(); }
  [[nodiscard]] bool touch(std::string_view input, std::int64_t value) override {
    return inner_->touch(input, value);
  }

  [[nodiscard]] ImpairmentStatistics statistics() const noexcept { return paths_.statistics(); }

 private:
  ImpairedBus(std::unique_ptr<BusPort> inner, const Impairment& impairment);

  [[nodiscard]] bool is_gone() const noexcept;
  [[nodiscard]] std::optional<std::byte> carry(ImpairedPath& path, std::byte byte);
  [[nodiscard]] Ack missed();

  std::unique_ptr<BusPort> inner_;
  ImpairedPaths paths_;
  bool is_missed_ = false;   ///< the device did not see its address
  bool is_started_ = false;  ///< the inner bus is in a transaction
};

}  // namespace armjig
