// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "harness/link/impaired_path.hpp"
#include "harness/link/port_around.hpp"

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
///
/// A bus that does whole transactions only, as all real ones, gets what would arrive of one in a
/// single piece: it waits before and after, and never between two bytes; a message whose bytes are
/// all lost is left out together with its address; what is lost in the middle ends the transaction
/// with a stop.
class ImpairedBus final : public BusAround {
 public:
  /// Requires `inner`. Problems: `kUnsupported` for defects that a bus cannot have.
  [[nodiscard]] static Outcome<std::unique_ptr<ImpairedBus>> make(std::unique_ptr<BusPort> inner,
                                                                  const Impairment& impairment);

  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override;
  [[nodiscard]] Result<Ack> start(BusAddress address, Access access) override;
  [[nodiscard]] Result<Ack> write(std::byte byte) override;
  [[nodiscard]] Result<std::byte> read(Ack reply) override;
  Result<void> stop() override;

  [[nodiscard]] ImpairmentStatistics statistics() const noexcept { return paths_.statistics(); }

 private:
  ImpairedBus(std::unique_ptr<BusPort> inner, const Impairment& impairment);

  [[nodiscard]] bool is_gone() const noexcept { return paths_.is_broken(Instant::max()); }
  [[nodiscard]] Transfer carry(const BusMessage& message, std::vector<std::byte>& written);
  [[nodiscard]] std::optional<std::byte> carry(ImpairedPath& path, std::byte byte);
  [[nodiscard]] Ack missed();

  ImpairedPaths paths_;
  bool is_missed_ = false;   ///< the device did not see its address
  bool is_started_ = false;  ///< the inner bus is in a transaction
};

}  // namespace armjig
