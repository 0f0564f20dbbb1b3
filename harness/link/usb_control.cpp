// SPDX-License-Identifier: Apache-2.0
#include "harness/link/usb_control.hpp"

#include <fmt/core.h>
#include <libusb.h>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace armjig {
namespace {

constexpr unsigned kPatienceMs = 1000;
constexpr unsigned kLastPatienceMs = 50;  // the next one may come through

struct ExitContext {
  void operator()(libusb_context* context) const noexcept { libusb_exit(context); }
};
struct CloseDevice {
  void operator()(libusb_device_handle* handle) const noexcept { libusb_close(handle); }
};
using Context = std::unique_ptr<libusb_context, ExitContext>;
using Handle = std::unique_ptr<libusb_device_handle, CloseDevice>;

Error error_from_libusb(int code) noexcept {
  switch (code) {
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_IO:
      return {ErrorCode::kDisconnected, code};
    case LIBUSB_ERROR_TIMEOUT:
      return {ErrorCode::kTimedOut, code};
    case LIBUSB_ERROR_PIPE:
      return {ErrorCode::kUnsupported, code};
    case LIBUSB_ERROR_ACCESS:
      return {ErrorCode::kNoPermission, code};
    case LIBUSB_ERROR_BUSY:
      return {ErrorCode::kBusy, code};
    default:
      return {ErrorCode::kSystem, code};
  }
}

auto problem_from_libusb(int code, const std::string& where) {
  const auto error = error_from_libusb(code);
  const auto* const hint =
      error.code == ErrorCode::kNoPermission ? "the udev rule 60-armjig.rules has to let you use "
                                               "it; 'armjig doctor --udev-rules' prints it"
      : error.code == ErrorCode::kBusy
          ? "a kernel driver or another program has it; 'rmmod i2c-tiny-usb' frees it, or use its "
            "bus as i2c:/dev/i2c-N"
          : libusb_error_name(code);
  return problem(error.code, where, hint);
}

class LibusbControl final : public UsbControl {
 public:
  LibusbControl(Context context, Handle handle) noexcept
      : context_{std::move(context)}, handle_{std::move(handle)} {}

  Result<std::size_t> read(UsbRequest request, std::span<std::byte> into) override {
    return transfer(LIBUSB_ENDPOINT_IN, request, into);
  }
  Result<std::size_t> write(UsbRequest request, Bytes bytes) override {
    // libusb has one function for both directions; it does not write to what goes out.
    return transfer(LIBUSB_ENDPOINT_OUT, request,
                    {const_cast<std::byte*>(bytes.data()), bytes.size()});
  }
  /// libusb waits until the files of devices are writable; this context has one device.
  [[nodiscard]] std::optional<int> descriptor() const override {
    const auto** all = libusb_get_pollfds(context_.get());
    std::optional<int> found;
    for (const auto** one = all; one != nullptr && *one != nullptr; ++one) {
      if ((*one)->events == POLLOUT) found = (*one)->fd;
    }
    libusb_free_pollfds(all);
    return found;
  }

 private:
  Result<std::size_t> transfer(int direction, UsbRequest request, std::span<std::byte> bytes) {
    const int type = direction | LIBUSB_REQUEST_TYPE_VENDOR | LIBUSB_RECIPIENT_INTERFACE;
    const int done = libusb_control_transfer(handle_.get(), static_cast<std::uint8_t>(type),
                                             request.request, request.value, request.index,
                                             reinterpret_cast<unsigned char*>(bytes.data()),
                                             static_cast<std::uint16_t>(bytes.size()), kPatienceMs);
    if (done < 0) return tl::unexpected{error_from_libusb(done)};
    return static_cast<std::size_t>(done);
  }

  Context context_;
  Handle handle_;
};

std::string serial_number_of(libusb_device_handle* handle, std::uint8_t index) {
  std::array<unsigned char, 256> text{};
  const int size = index == 0 ? 0
                              : libusb_get_string_descriptor_ascii(handle, index, text.data(),
                                                                   static_cast<int>(text.size()));
  return {text.begin(), text.begin() + std::max(size, 0)};
}

/// A device that is open, and the number that is written on it.
struct Candidate {
  Handle handle;
  std::string serial_number;
};

/// All that have one of the numbers and can be opened. `refusal` is why another could not be.
std::vector<Candidate> open_all(libusb_context* context, std::span<const UsbNumbers> numbers,
                                int& refusal) {
  libusb_device** list = nullptr;
  const auto count = libusb_get_device_list(context, &list);
  std::vector<Candidate> candidates;
  for (auto* device : std::span{list, static_cast<std::size_t>(std::max<ssize_t>(count, 0))}) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(device, &descriptor) != 0) continue;
    const bool is_wanted = std::ranges::any_of(numbers, [&](UsbNumbers wanted) {
      return wanted.vendor == descriptor.idVendor && wanted.product == descriptor.idProduct;
    });
    if (!is_wanted) continue;
    libusb_device_handle* opened = nullptr;
    if (const int code = libusb_open(device, &opened); code != 0) {
      refusal = code;
      continue;
    }
    Handle handle{opened};
    auto serial_number = serial_number_of(opened, descriptor.iSerialNumber);
    candidates.push_back({std::move(handle), std::move(serial_number)});
  }
  if (count >= 0) libusb_free_device_list(list, 1);
  return candidates;
}

std::string names_of(const std::vector<Candidate>& candidates) {
  std::string names;
  for (const auto& candidate : candidates) {
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", candidate.serial_number);
  }
  return names;
}

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

Outcome<std::unique_ptr<UsbControl>> open_usb_control(std::span<const UsbNumbers> numbers,
                                                      std::string_view serial_number,
                                                      const std::string& where) {
  libusb_context* made = nullptr;
  if (const int code = libusb_init(&made); code != 0) return problem_from_libusb(code, where);
  Context context{made};
  int refusal = 0;
  auto candidates = open_all(made, numbers, refusal);
  if (!serial_number.empty()) {
    std::erase_if(candidates, [&](const Candidate& candidate) {
      return candidate.serial_number != serial_number;
    });
  }
  if (candidates.empty() && refusal != 0) return problem_from_libusb(refusal, where);
  if (candidates.empty()) {
    return problem(ErrorCode::kNotFound, where, "is the adapter plugged in? 'lsusb' lists what is");
  }
  if (candidates.size() > 1) {
    return problem(ErrorCode::kBadTarget, where,
                   "there are several: write one of their serial numbers behind the colon: " +
                       names_of(candidates));
  }
  auto handle = std::move(candidates.front().handle);
  candidates.clear();
  if (const int code = libusb_claim_interface(handle.get(), 0); code != 0) {
    return problem_from_libusb(code, where);
  }
  return std::make_unique<LibusbControl>(std::move(context), std::move(handle));
}

}  // namespace armjig
