// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/link/usb_id.hpp"

namespace armjig {

/// A control transfer: the vendor's request to an interface.
struct UsbRequest {
  std::uint8_t request{};
  std::uint16_t value{};
  std::uint16_t index{};
};

/// Control transfers to one USB device. Errors: `kDisconnected` (pulled out), `kTimedOut`,
/// `kUnsupported` (the device refuses the request), `kSystem` with libusb's number.
class UsbControl {
 public:
  UsbControl() = default;
  UsbControl(const UsbControl&) = delete;
  UsbControl& operator=(const UsbControl&) = delete;
  virtual ~UsbControl() = default;

  /// Bytes that the device sent, at most as many as there is room for.
  [[nodiscard]] virtual Result<std::size_t> read(UsbRequest request, std::span<std::byte> into) = 0;
  /// Bytes that the device took.
  [[nodiscard]] virtual Result<std::size_t> write(UsbRequest request, Bytes bytes) = 0;
  /// The file of the device, for `send_last_request`; none if it is no real one.
  [[nodiscard]] virtual std::optional<int> descriptor() const { return std::nullopt; }
};

/// Writes through the file of a device that libusb has opened, in a process that inherits it: what
/// was claimed belongs to the file. Does nothing but a system call, and may fail.
void send_last_request(int descriptor, UsbRequest request, Bytes bytes) noexcept;

/// Opens the only device that is meant, and claims its first interface. Problems: those of
/// `open_usb`; `where` is what the user wrote.
[[nodiscard]] Outcome<std::unique_ptr<UsbControl>> open_usb_control(const UsbChoice& choice,
                                                                    const std::string& where);

}  // namespace armjig
