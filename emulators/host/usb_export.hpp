// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/host/client_link.hpp"
#include "emulators/host/host.hpp"
#include "emulators/host/usb_wire.hpp"
#include "emulators/usb/function.hpp"
#include "harness/core/device_input.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// An emulated USB device for one machine after the other, real or virtual, that finds it on a
/// socket. All of it runs on the thread of one io_context.
class UsbExport {
 public:
  /// What it asks and tells.
  struct Events {
    std::function<Instant()> catch_up;  ///< brings what is emulated to the present; its time
    std::function<Instant()> now;       ///< the same without doing so
    std::function<std::chrono::steady_clock::time_point(Instant)> wall_time;
    std::function<void()> on_turn;  ///< the device was told something
    std::function<void(std::string_view line)> on_log;
  };

  UsbExport() = default;
  UsbExport(const UsbExport&) = delete;
  UsbExport& operator=(const UsbExport&) = delete;
  virtual ~UsbExport() = default;

  /// The function takes or gives now what it did not before.
  virtual void advance() = 0;
  /// Pulls the cable out, or plugs it in.
  virtual void set_cable(Cable cable) = 0;
  /// For people: `usbredir:PATH`, `usbip:HOST:PORT`.
  [[nodiscard]] virtual std::string target() const = 0;
  /// Machines that came, and bytes on the socket.
  [[nodiscard]] virtual LinkStatistics statistics() const = 0;
};

/// Makes a place where clients find the device. The socket is for this user only, and one that a
/// dead process left is taken over; the port is on 127.0.0.1. `function` outlives the export.
/// Problems: `kBusy` (somebody listens there, or it is another file), `kBadValue` (too long a
/// path), `kNoPermission`, `kNotFound` (no such folder), `kSystem`.
[[nodiscard]] Outcome<std::unique_ptr<UsbExport>> export_usb(boost::asio::io_context& context,
                                                             const UsbSocket& place,
                                                             usb::Function& function,
                                                             UsbExport::Events events);

/// The hand at the cables of a front, as an input of what is hosted.
class CableHand {
 public:
  /// `set` is called as long as this is there.
  void add(std::function<void(Cable)> set) { cables_.push_back(std::move(set)); }
  /// None while there is no cable.
  [[nodiscard]] std::vector<DeviceInput> inputs() const;
  /// Does it to all of them. False: there is no such input, or it does not take the value.
  [[nodiscard]] bool set_input(std::string_view name, std::int64_t value) const;

 private:
  std::vector<std::function<void(Cable)>> cables_;
};

}  // namespace armjig
