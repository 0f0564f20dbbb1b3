// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig::morap::drive {

/// How a transaction ended: the codes of the vendor's master library, and some of ours.
enum class BusCode : std::uint8_t {
  kOk = 0,
  kNoSuchAddress = 1,   ///< the address was not acknowledged; nothing else was sent
  kByteRefused = 2,     ///< some data byte was not acknowledged; the rest was sent all the same
  kStartCollision = 3,  ///< the bus was taken or held at the start; there was no stop
  kByteCollision = 4,   ///< the same at a byte; the rest was left out
  kTimedOut = 6,        ///< a device held the clock; the vendor's library hangs here
  kGone = 7,            ///< the adapter was pulled out
  kForbidden = 8,       ///< the guard before a real device refused it; nothing was sent
  kAway = 9,            ///< the adapter was pulled out, and is waited for
};

/// One sentence without a full stop.
[[nodiscard]] std::string_view describe(BusCode code) noexcept;

/// The error that it is to users. Requires that it is not `kOk`.
[[nodiscard]] ErrorCode error_of(BusCode code) noexcept;

/// Who answered, up to the end or to the first trouble with the bus.
struct ScanResult {
  BusCode code = BusCode::kOk;
  std::vector<BusAddress> addresses;
};

/// Transactions as the vendor's master library does them: no repeated start, no second try.
class Master {
 public:
  /// The port outlives the master.
  explicit Master(BusPort& port) noexcept : port_{&port} {}

  /// Start, address, data, stop.
  BusCode transmit(BusAddress address, Bytes data);
  /// Fills `out`; what was not read stays as it was. An empty one addresses the device and stops.
  BusCode receive(BusAddress address, std::span<std::byte> out);
  /// A write of nothing: is anybody there?
  BusCode poke(BusAddress address) { return transmit(address, {}); }

  /// Pokes all addresses that are not reserved, 08 to 77.
  [[nodiscard]] ScanResult scan();

  void wait(Duration duration) { port_->wait_until(port_->now() + duration); }
  [[nodiscard]] Instant now() const { return port_->now(); }

 private:
  BusCode transfer(const BusMessage& message);

  BusPort* port_;
};

}  // namespace armjig::morap::drive
