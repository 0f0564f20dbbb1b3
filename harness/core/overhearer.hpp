// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// Something on one of the connections of a server.
struct ConnectionEvent {
  enum class Kind : std::uint8_t {
    kBegun,
    kToServer,    ///< `bytes`, as they came
    kFromServer,  ///< `bytes`
    kHalfClosed,  ///< the client sends no more
    kClosed,      ///< by the client
    kReset,       ///< by the client
    kDropped,     ///< ended in any way by the server
  };
  Instant time{};
  std::uint32_t connection{};  ///< numbered in the order in which they come
  Kind kind{};
  Bytes bytes;
};

/// What passed on a bus from a start to the next one, or to the stop.
struct BusPart {
  enum class Ending : std::uint8_t { kStop, kNextStart };

  Instant begin{};
  Instant end{};
  std::uint8_t address{};
  bool is_read{};
  Bytes bytes;            ///< written, a refused one among them, or read
  std::string_view acks;  ///< of the device: `A` or `N` for the address and each byte written
  Ending ending{};
  std::optional<ErrorCode> error;  ///< of the bus
};

/// What was acknowledged of it: the byte with address and direction, then the data bytes. Empty if
/// the address was not.
[[nodiscard]] inline std::vector<std::byte> acknowledged(const BusPart& part) {
  if (!part.acks.starts_with('A')) return {};
  std::vector<std::byte> message{
      static_cast<std::byte>(unsigned{part.address} << 1U | (part.is_read ? 1U : 0U))};
  for (std::size_t i = 0; i < part.bytes.size(); ++i) {
    const bool is_taken = part.is_read || (i + 1 < part.acks.size() && part.acks[i + 1] == 'A');
    if (is_taken) message.push_back(part.bytes[i]);
  }
  return message;
}

/// Is told what passes between a device and the programs that talk to it, on one kind of link, in
/// the order of time. Of a server only what is on a connection, of a bus only its parts.
class Overhearer {
 public:
  Overhearer() = default;
  Overhearer(const Overhearer&) = delete;
  Overhearer& operator=(const Overhearer&) = delete;
  virtual ~Overhearer() = default;

  virtual void to_device(Instant time, Bytes bytes) = 0;
  virtual void from_device(Instant time, Bytes bytes) = 0;
  virtual void on_connection(const ConnectionEvent& event) = 0;
  virtual void on_bus(const BusPart& part) = 0;
  /// Somebody did that beside the link.
  virtual void on_input(Instant /*time*/, std::string_view /*name*/, std::int64_t /*value*/) {}
  /// Nothing more has passed until now.
  virtual void wait_until(Instant /*time*/) {}
  /// Whoever carries the bytes did not look between these times: what came then is told afterwards.
  virtual void overlook(Instant /*from*/, Instant /*to*/) {}
};

}  // namespace armjig
