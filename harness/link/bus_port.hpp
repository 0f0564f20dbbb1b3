// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/link/endpoint.hpp"

namespace armjig {

/// A seven-bit I2C address.
struct BusAddress {
  std::uint8_t value{};

  friend auto operator<=>(const BusAddress&, const BusAddress&) = default;
};

enum class Ack : std::uint8_t { kAck, kNack };

enum class Access : std::uint8_t { kWrite, kRead };

/// A part of a transaction: a start, the address, some bytes.
struct BusMessage {
  BusAddress address{};
  Access access{};
  Bytes write{};                ///< what to write
  std::span<std::byte> read{};  ///< where to put what is read; as much as it is long
};

[[nodiscard]] constexpr BusMessage write_to(BusAddress address, Bytes bytes) noexcept {
  return {address, Access::kWrite, bytes, {}};
}
[[nodiscard]] constexpr BusMessage read_from(BusAddress address,
                                             std::span<std::byte> into) noexcept {
  return {address, Access::kRead, {}, into};
}

/// The byte with which a message begins on the wire.
[[nodiscard]] constexpr std::byte head_of(const BusMessage& message) noexcept {
  return static_cast<std::byte>(message.address.value << 1 |
                                (message.access == Access::kRead ? 1 : 0));
}

/// What the devices made of a transaction. It ends at the first refusal.
enum class Transfer : std::uint8_t { kDone, kAddressRefused, kByteRefused };

/// An I2C bus seen from its master. On a virtual clock every operation takes as long as its bits
/// do.
///
/// Every bus can do whole transactions. One that can also be led byte by byte lets repeated starts,
/// short reads and refused bytes be said; behind an operating system or an adapter there is no such
/// thing.
class BusPort : public Endpoint {
 public:
  using Access = armjig::Access;

  /// Whether single operations can be done; if not, each of them fails with `kUnsupported`.
  [[nodiscard]] virtual bool has_operations() const noexcept { return true; }

  /// A transaction: its messages with repeated starts between, and a stop. Errors: `kBusy`
  /// (arbitration lost, a line held down), `kTimedOut` (a device holds the clock), `kDisconnected`
  /// (the adapter is gone), `kNotFound` (it is away and may come back), `kBadValue` (more or longer
  /// messages than the bus can do).
  [[nodiscard]] virtual Result<Transfer> transfer(std::span<const BusMessage> messages);

  /// Start condition (a repeated one inside a transaction), then the address. `kNack`: nobody is
  /// there. Errors: `kBusy` (arbitration lost, a line held down), `kTimedOut`.
  [[nodiscard]] virtual Result<Ack> start(BusAddress address, Access access) = 0;

  /// Writes one byte; the answer is the device's.
  [[nodiscard]] virtual Result<Ack> write(std::byte byte) = 0;

  /// Reads one byte and answers it with `reply`.
  [[nodiscard]] virtual Result<std::byte> read(Ack reply) = 0;

  /// Stop condition.
  virtual Result<void> stop() = 0;

  /// Nine clocks and a stop, for a device that holds the data line in the middle of a byte.
  /// `kUnsupported` where the clock cannot be moved by hand; `kBusy` if the line is still held.
  virtual Result<void> recover() { return fail(ErrorCode::kUnsupported); }

  /// Lets time pass.
  virtual void wait_until(Instant time) = 0;
};

}  // namespace armjig
