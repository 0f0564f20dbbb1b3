// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "conformance/port_bench.hpp"
#include "harness/core/bytes.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig {

/// A conversation with devices on an I2C bus. The same calls mean the same in virtual and in real
/// time. Once a case is decided, or the port has failed, nothing passes and no time goes by.
class BusBench : public DissectedBench<BusPort> {
 public:
  BusBench(Rig<BusPort> rig, std::unique_ptr<Dissector> dissector);

  enum class End : std::uint8_t {
    kStop,
    kOpen,  ///< the next transaction begins with a repeated start
  };

  /// What was acknowledged of a write.
  struct Written {
    bool is_addressed = false;
    std::size_t refused = 0;  ///< bytes without acknowledgement

    [[nodiscard]] bool is_whole() const noexcept { return is_addressed && refused == 0; }
  };
  Written write(BusAddress address, Bytes bytes, End end = End::kStop);

  /// None if nobody is there.
  std::optional<std::vector<std::byte>> read(BusAddress address, std::size_t size,
                                             End end = End::kStop);

  /// Reads a byte, lets `between` happen, and reads the rest. Skips the case on a bus that does
  /// only whole transactions.
  template <class Between>
  std::vector<std::byte> read_around(BusAddress address, std::size_t size, Between between);

  void pause(Duration duration);
  void pause_until(Instant time);

 private:
  /// The value, or nothing once the port has failed.
  template <class T>
  std::optional<T> taken(Result<T> result) {
    return is_done(result) ? std::optional{*result} : std::nullopt;
  }
  bool connect(BusAddress address, BusPort::Access access);
  void finish(End end);
  [[nodiscard]] bool is_whole_only() const { return !port().has_operations(); }
  /// Does what was left open, and `last` behind it.
  [[nodiscard]] std::optional<Transfer> transfer(const BusMessage& last);
  Written write_whole(BusAddress address, Bytes bytes, End end);
  std::optional<std::vector<std::byte>> read_whole(BusAddress address, std::size_t size);
  void remember(std::byte head, Bytes bytes);

  /// A write that waits for what follows it in the same transaction.
  struct Open {
    BusAddress address;
    std::vector<std::byte> bytes;
  };

  std::vector<Open> open_;
};

template <class Between>
std::vector<std::byte> BusBench::read_around(BusAddress address, std::size_t size,
                                             Between between) {
  std::vector<std::byte> bytes(size);
  if (is_deaf()) return bytes;
  if (is_whole_only()) {
    skip("needs a bus that is led byte by byte");
    return bytes;
  }
  if (!connect(address, BusPort::Access::kRead)) return bytes;
  for (std::size_t i = 0; i < size && !error(); ++i) {
    if (i == 1) between();
    const auto byte = taken(port().read(i + 1 < size ? Ack::kAck : Ack::kNack));
    bytes[i] = byte.value_or(std::byte{});
  }
  finish(End::kStop);
  return bytes;
}

}  // namespace armjig
