// SPDX-License-Identifier: Apache-2.0
#include "harness/link/usb_control.hpp"

#include <libusb.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <utility>

#include "harness/link/usb_device.hpp"

namespace armjig {
namespace {

constexpr unsigned kPatienceMs = 1000;
constexpr unsigned kLastPatienceMs = 50;  // the next one may come through

constexpr UsbHints kAdapterHints{
    .absent = "is the adapter plugged in? 'lsusb' lists what is",
    .several = "there are several: write one of their serial numbers behind the colon: ",
    .busy =
        "a kernel driver or another program has it; 'rmmod i2c-tiny-usb' frees it, or use its "
        "bus as i2c:/dev/i2c-N"};

class LibusbControl final : public UsbControl {
 public:
  explicit LibusbControl(OpenUsb device) noexcept : device_{std::move(device)} {}

  Result<std::size_t> read(UsbRequest request, std::span<std::byte> into) override {
    return transfer(LIBUSB_ENDPOINT_IN, request, into);
  }
  Result<std::size_t> write(UsbRequest request, Bytes bytes) override {
    // libusb has one function for both directions; it does not write to what goes out.
    return transfer(LIBUSB_ENDPOINT_OUT, request,
                    {const_cast<std::byte*>(bytes.data()), bytes.size()});
  }
  [[nodiscard]] std::optional<int> descriptor() const override { return device_.file(); }

 private:
  Result<std::size_t> transfer(int direction, UsbRequest request, std::span<std::byte> bytes) {
    const int type = direction | LIBUSB_REQUEST_TYPE_VENDOR | LIBUSB_RECIPIENT_INTERFACE;
    const int done = libusb_control_transfer(device_.handle.get(), static_cast<std::uint8_t>(type),
                                             request.request, request.value, request.index,
                                             reinterpret_cast<unsigned char*>(bytes.data()),
                                             static_cast<std::uint16_t>(bytes.size()), kPatienceMs);
    if (done < 0) return tl::unexpected{error_from_libusb(done)};
    return static_cast<std::size_t>(done);
  }

  OpenUsb device_;
};

}  // namespace

void send_last_request(int descriptor, UsbRequest request, Bytes bytes) noexcept {
  usbdevfs_ctrltransfer transfer{.bRequestType = int{LIBUSB_ENDPOINT_OUT} |
                                                 LIBUSB_REQUEST_TYPE_VENDOR |
                                                 LIBUSB_RECIPIENT_INTERFACE,
                                 .bRequest = request.request,
                                 .wValue = request.value,
                                 .wIndex = request.index,
                                 .wLength = static_cast<std::uint16_t>(bytes.size()),
                                 .timeout = kLastPatienceMs,
                                 .data = const_cast<std::byte*>(bytes.data())};
  ::ioctl(descriptor, USBDEVFS_CONTROL, &transfer);
}

Outcome<std::unique_ptr<UsbControl>> open_usb_control(const UsbChoice& choice,
                                                      const std::string& where) {
  auto device = open_usb(choice, where, kAdapterHints);
  if (!device) return tl::unexpected{device.error()};
  if (const int code = libusb_claim_interface(device->handle.get(), 0); code != 0) {
    return problem_from_libusb(code, where, kAdapterHints);
  }
  return std::make_unique<LibusbControl>(*std::move(device));
}

}  // namespace armjig
