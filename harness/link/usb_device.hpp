// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "harness/core/error.hpp"
#include "harness/link/usb_id.hpp"

struct libusb_context;
struct libusb_device_handle;

/// USB devices of this machine without a kernel driver, as libusb opens them.
namespace armjig {

struct ExitUsb {
  void operator()(libusb_context* context) const noexcept;
};
struct CloseUsb {
  void operator()(libusb_device_handle* handle) const noexcept;
};

/// A device that is open; nothing of it is claimed.
struct OpenUsb {
  std::unique_ptr<libusb_context, ExitUsb> context;
  std::unique_ptr<libusb_device_handle, CloseUsb> handle;

  /// Its file, by which a process that inherits it can send; none if libusb does not tell.
  [[nodiscard]] std::optional<int> file() const;
};

/// What a user can do about a device that cannot be had.
struct UsbHints {
  std::string_view absent;
  std::string_view several;  ///< followed by their serial numbers and places
  std::string_view busy;
};

/// `kDisconnected` (pulled out), `kTimedOut`, `kUnsupported` (the device refuses the request),
/// `kNoPermission`, `kBusy`, and `kSystem` for the rest, with libusb's number.
[[nodiscard]] Error error_from_libusb(int code) noexcept;

/// The same for users.
[[nodiscard]] tl::unexpected<Problem> problem_from_libusb(int code, const std::string& where,
                                                          const UsbHints& hints);

/// Opens the only device that is meant. Problems: `kNotFound`, `kBadTarget` (several),
/// `kNoPermission` (names the rule of udev that helps), `kBusy`, `kSystem`; `where` is what the
/// user wrote.
[[nodiscard]] Outcome<OpenUsb> open_usb(const UsbChoice& choice, const std::string& where,
                                        const UsbHints& hints);

/// Where a device is: its bus and ports, as `1-2.3`, by which /sys calls it, too.
[[nodiscard]] std::string place_of(const OpenUsb& device);

}  // namespace armjig
