// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "emulators/host/client_link.hpp"
#include "emulators/memory/hosted.hpp"
#include "emulators/usb/description.hpp"
#include "harness/core/error.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig {

/// A UNIX socket for clients of usbredir, such as QEMU.
struct UsbredirSocket {
  std::string path;
};
/// A port of 127.0.0.1 for clients of USB/IP, such as `usbip attach`; 0: any that is free.
struct UsbipPort {
  std::uint16_t number{};
};
using UsbSocket = std::variant<UsbredirSocket, UsbipPort>;

/// A USB device that is exported: a stream is a serial port (CDC-ACM), a bus is behind an adapter
/// of the i2c-tiny-usb family, which has numbers of its own.
struct UsbOptions {
  usb::Identity identity;
  UsbSocket place;
};

/// Hosts that share one are served by one thread: `run` and `stop` of one are those of all. Many
/// devices cost far less on one than on a thread each. As soon as the first host is destroyed, or
/// one cannot be opened, none of the others runs any more.
class HostThread;
[[nodiscard]] std::shared_ptr<HostThread> make_host_thread();

/// Where and how a device is hosted. A stream has at least one link, a server TCP and nothing else,
/// a bus USB or nothing (`Host::with_bus`).
struct HostOptions {
  std::optional<PtyOptions> pty;
  std::optional<TcpOptions> tcp;
  std::optional<TcpOptions> rfc2217;  ///< of a stream, a serial port over Telnet
  std::vector<UsbOptions>
      usb{};         ///< each is a device of its own; the inputs at their cables do to all
  double speed = 1;  ///< virtual over wall time, `PacedClock::kSlowest` to `kFastest`
  std::shared_ptr<HostThread> thread{};  ///< shared with other hosts; none: one of its own
  std::function<void(std::string_view line)> log = [](std::string_view /*line*/) {};
};

struct HostStatistics {
  LinkStatistics links;  ///< of all together
  Duration lost{};       ///< virtual time by which the device fell behind for want of CPU
};

/// Lets an emulated device live on the wall clock and talk to clients on real links. Bytes reach it
/// at the virtual time of their arrival, and leave when virtual time has come. When this process
/// had no time for that, the device is told so (`HostedDevice::overlook`).
///
/// The answers of a stream go to the link that sent last. A server has each connection with its
/// segments, half-close and reset; while it does not listen, connections are refused; what it does
/// not read stays in the kernel but for 16 KiB. A client that does not read loses whole messages
/// beyond 64 KiB.
///
/// One thread: everything but `stop`, `set_input` and `with_bus` belongs to the one that calls
/// `run`.
class Host {
 public:
  /// Listens from now on; clients are served once it runs. Problems: `kBadValue` (speed, links),
  /// and those of `open_pty_link` and `listen_on_tcp`.
  [[nodiscard]] static Outcome<Host> open(AnyHosted device, HostOptions options);
  Host(Host&& other) noexcept;
  Host& operator=(Host&& other) noexcept;
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  /// Stops listening and removes the stable link.
  ~Host();

  /// Where clients find the device, as `--target` takes it; stable links follow their terminals.
  [[nodiscard]] std::vector<std::string> targets() const;

  /// Serves clients until it is stopped.
  void run();

  /// Ends `run`, now or as soon as it begins. May be called from any thread.
  void stop();

  /// What `set_input` knows: the inputs of the device, and those of its cables.
  [[nodiscard]] std::vector<DeviceInput> inputs() const;

  /// Does something beside the device while `run` runs, and tells there whether there is an input
  /// of that name which takes the value. May be called from any thread.
  void set_input(std::string name, std::int64_t value, std::function<void(bool is_taken)> tell);

  /// Has `use` talk to the bus at its present time while `run` runs, and there, one after the
  /// other; comes back when wall time has reached the end of that, or without if `run` has ended.
  /// May be called from any thread but that. Requires a bus.
  void with_bus(const std::function<void(BusPort& bus)>& use);

  [[nodiscard]] HostStatistics statistics() const;

 private:
  class LoopOnAsio;
  explicit Host(std::unique_ptr<LoopOnAsio> loop) noexcept;

  std::unique_ptr<LoopOnAsio> loop_;
};

}  // namespace armjig
