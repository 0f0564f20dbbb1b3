// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"

/// What an emulated device looks like to whatever carries its bytes. There is no common base class:
/// these are concepts, and the device stays a plain value.
namespace armjig {

/// Bytes that left a device at `time`.
struct SentBytes {
  Instant time{};
  std::vector<std::byte> bytes;
};

/// The part of a device that keeps what it has sent, until somebody has fetched it.
template <class Sent>
class Sending {
 public:
  /// Since `clear_sent`, oldest first.
  [[nodiscard]] std::span<const Sent> sent() const noexcept { return sent_; }
  void clear_sent() noexcept { sent_.clear(); }

 protected:
  std::vector<Sent> sent_;
};

/// The part of a device around another one that knows which inputs that has, if it says so.
template <class Device>
class InputsOf {
 public:
  [[nodiscard]] static auto inputs() noexcept
    requires requires { Device::inputs(); }
  {
    return Device::inputs();
  }
};

/// A device on a byte stream. Times that it is given never decrease. `receive` takes bytes that
/// become readable at a time, `advance_to` does everything up to and including a time, `next_event`
/// tells when something may be sent if nothing more comes.
template <class Device>
concept EmulatedStream =
    std::copyable<Device> && requires(Device device, const Device& constant, Instant time) {
      device.receive(time, Bytes{});
      device.advance_to(time);
      { constant.next_event() } -> std::same_as<std::optional<Instant>>;
      { constant.sent() } -> std::convertible_to<std::span<const SentBytes>>;
      device.clear_sent();
    };

/// What a server does with the connection that it has.
struct SessionEvent {
  enum class Kind : std::uint8_t { kData, kEnd, kReset };

  Instant time{};
  Kind kind{};
  std::vector<std::byte> bytes;  ///< of `kData`
};

/// A device that serves one connection at a time. `connect` may answer whether it takes it.
template <class Device>
concept EmulatedServer =
    std::copyable<Device> && requires(Device device, const Device& constant, Instant time) {
      device.connect(time);
      device.receive(time, Bytes{});
      device.half_close(time);
      device.close(time);
      device.reset(time);
      device.advance_to(time);
      { constant.next_event() } -> std::same_as<std::optional<Instant>>;
      { constant.sent() } -> std::convertible_to<std::span<const SessionEvent>>;
      device.clear_sent();
    };

/// Connections are numbered by their server, from 0 in the order in which they come.
using ConnectionId = std::uint32_t;

/// What one of its clients sees of a server.
struct ServerEvent {
  Instant time{};
  ConnectionId connection{};
  SessionEvent::Kind kind{};
  std::vector<std::byte> bytes;  ///< of `kData`
};

/// A device that knows many connections. While it does not listen, connections are to be refused;
/// `connect` may answer none for the same. `unread` tells how many bytes of a client it has not
/// read. `close`: the client has closed both directions. Numbers that are not known any more are
/// passed over.
template <class Device>
concept EmulatedMultiServer =
    std::copyable<Device> &&
    requires(Device device, const Device& constant, Instant time, ConnectionId id) {
      { constant.is_listening() } -> std::same_as<bool>;
      { device.connect(time) } -> std::same_as<std::optional<ConnectionId>>;
      device.receive(time, id, Bytes{});
      device.half_close(time, id);
      device.close(time, id);
      device.reset(time, id);
      { constant.unread(id) } -> std::convertible_to<std::size_t>;
      device.advance_to(time);
      { constant.next_event() } -> std::same_as<std::optional<Instant>>;
      { constant.sent() } -> std::convertible_to<std::span<const ServerEvent>>;
      device.clear_sent();
    };

/// Lets a server find what it looks for before it listens, by which nobody shall be kept waiting:
/// a second at most. The server's time.
template <class Server>
[[nodiscard]] Instant wait_until_listening(Server& server) {
  Instant time{};
  while (!server.is_listening()) {
    const auto next = server.next_event();
    if (!next || *next > at(std::chrono::seconds{1})) break;
    time = *next;
    server.advance_to(time);
  }
  return time;
}

/// A device at the other end of an I2C bus, byte by byte. `write` tells whether it acknowledges. It
/// may have more (`emulators/i2c/bus.hpp`).
template <class Device>
concept EmulatedBusDevice = std::copyable<Device> && requires(Device device, Instant time) {
  { device.acknowledges(std::uint8_t{}) } -> std::same_as<bool>;
  { device.write(time, std::byte{}) } -> std::same_as<bool>;
  { device.read(time) } -> std::same_as<std::byte>;
};

/// What came of one operation on a bus.
struct BusReply {
  enum class Outcome : std::uint8_t { kAck, kNack, kArbitrationLost, kDataHeld };

  Outcome outcome{};
  Instant end{};     ///< of the operation; long after its bits if a device stretches the clock
  std::byte byte{};  ///< of a read
};

/// A whole I2C bus: operations of its master go in with the time at which they begin.
template <class Bus>
concept EmulatedBus = std::copyable<Bus> && requires(Bus bus, Instant time) {
  { bus.start(time, std::uint8_t{}, /*is_read=*/bool{}) } -> std::same_as<BusReply>;
  { bus.write(time, std::byte{}) } -> std::same_as<BusReply>;
  { bus.read(time) } -> std::same_as<BusReply>;
  { bus.stop(time) } -> std::same_as<BusReply>;
  { bus.recover(time) } -> std::same_as<BusReply>;
};

/// The device that is held by value or by a pointer.
template <class Held>
[[nodiscard]] constexpr auto& device_in(Held& held) noexcept {
  if constexpr (requires { *held; }) {
    return *held;
  } else {
    return held;
  }
}

}  // namespace armjig
