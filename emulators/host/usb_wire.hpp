// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "emulators/usb/device.hpp"
#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// Whether the cable of a device is in.
enum class Cable : std::uint8_t { kOut, kIn };

/// What one client of an exported USB device has heard and said, in one of the protocols that carry
/// USB transfers over a connection. No I/O: bytes in, bytes out.
class UsbWire {
 public:
  UsbWire() = default;
  UsbWire(const UsbWire&) = delete;
  UsbWire& operator=(const UsbWire&) = delete;
  virtual ~UsbWire() = default;

  /// What the client sent. False: it broke the protocol, and is to be let go.
  [[nodiscard]] virtual bool receive(Instant time, Bytes bytes) = 0;
  /// Tells the client how a transfer ended.
  virtual void tell(const usb::Completion& completion) = 0;
  /// The cable was plugged in or pulled out; the device was reset before. False: the protocol can
  /// say that only by ending the connection.
  [[nodiscard]] virtual bool set_cable(Cable cable) = 0;

  /// What the client gets, in order; whoever has sent some of it takes it away.
  [[nodiscard]] std::vector<std::byte>& outgoing() noexcept { return outgoing_; }

 protected:
  std::vector<std::byte> outgoing_;  // NOLINT(*-non-private-member-variables-in-classes)
};

/// usbredir, as QEMU and SPICE speak it; this is its usb-host side. `device` outlives it.
[[nodiscard]] std::unique_ptr<UsbWire> make_usbredir_wire(usb::Device& device, Cable cable);

/// USB/IP, as Linux' vhci-hcd speaks it. `device` outlives it.
[[nodiscard]] std::unique_ptr<UsbWire> make_usbip_wire(usb::Device& device, Cable cable);

}  // namespace armjig
