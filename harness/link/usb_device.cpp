// SPDX-License-Identifier: Apache-2.0
#include "harness/link/usb_device.hpp"

#include <fmt/core.h>
#include <libusb.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace armjig {
namespace {

constexpr auto kPermissionHint =
    "the udev rule 60-armjig.rules has to let you use it; 'armjig doctor --udev-rules' prints it";

using Handle = std::unique_ptr<libusb_device_handle, CloseUsb>;

std::string place_of(libusb_device* device) {
  constexpr int kDeepest = 7;  // as many hubs as USB allows
  std::array<std::uint8_t, kDeepest> ports{};
  const int depth = libusb_get_port_numbers(device, ports.data(), kDeepest);
  auto place = fmt::format("{}", libusb_get_bus_number(device));
  for (int i = 0; i < depth; ++i) {
    place += fmt::format("{}{}", i == 0 ? '-' : '.', ports.at(static_cast<std::size_t>(i)));
  }
  return place;
}

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

/// One that could not be opened.
struct Refused {
  int code = 0;  ///< 0: there is none
  UsbId id{};
};

/// What can be told without opening it.
bool is_meant(const UsbChoice& choice, libusb_device* device,
              const libusb_device_descriptor& descriptor) {
  const UsbId id{descriptor.idVendor, descriptor.idProduct};
  const bool has_id = choice.ids.empty() || std::ranges::count(choice.ids, id) > 0;
  return has_id && (choice.place.empty() || choice.place == place_of(device));
}

/// All that are meant and can be opened.
std::vector<Candidate> open_all(libusb_context* context, const UsbChoice& choice,
                                Refused& refused) {
  libusb_device** list = nullptr;
  const auto count = libusb_get_device_list(context, &list);
  std::vector<Candidate> candidates;
  for (auto* device : std::span{list, static_cast<std::size_t>(std::max<ssize_t>(count, 0))}) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(device, &descriptor) != 0) continue;
    if (!is_meant(choice, device, descriptor)) continue;
    libusb_device_handle* opened = nullptr;
    if (const int code = libusb_open(device, &opened); code != 0) {
      refused = {code, {descriptor.idVendor, descriptor.idProduct}};
      continue;
    }
    Handle handle{opened};
    auto serial_number = serial_number_of(opened, descriptor.iSerialNumber);
    if (!choice.serial_number.empty() && serial_number != choice.serial_number) continue;
    candidates.push_back({std::move(handle), std::move(serial_number)});
  }
  if (count >= 0) libusb_free_device_list(list, 1);
  return candidates;
}

std::string names_of(const std::vector<Candidate>& candidates) {
  std::string names;
  for (const auto& [handle, serial_number] : candidates) {
    names += fmt::format("{}'{}' at {}", names.empty() ? "" : ", ", serial_number,
                         place_of(libusb_get_device(handle.get())));
  }
  return names;
}

/// Boards of others are not in our rules: they need the line.
tl::unexpected<Problem> problem_of_refused(const Refused& refused, const std::string& where,
                                           const UsbHints& hints) {
  auto refusal = problem_from_libusb(refused.code, where, hints);
  if (refusal.value().code == ErrorCode::kNoPermission) {
    refusal.value().hint +=
        fmt::format(R"(, and a board that it does not know needs the line SUBSYSTEM=="usb", )"
                    R"(ATTR{{idVendor}}=="{:04x}", ATTR{{idProduct}}=="{:04x}", TAG+="uaccess")",
                    refused.id.vendor, refused.id.product);
  }
  return refusal;
}

}  // namespace

void ExitUsb::operator()(libusb_context* context) const noexcept { libusb_exit(context); }
void CloseUsb::operator()(libusb_device_handle* handle) const noexcept { libusb_close(handle); }

/// libusb waits until the files of devices are writable; this context has one device.
std::optional<int> OpenUsb::file() const {
  const auto** all = libusb_get_pollfds(context.get());
  std::optional<int> found;
  for (const auto** one = all; one != nullptr && *one != nullptr; ++one) {
    if ((*one)->events == POLLOUT) found = (*one)->fd;
  }
  libusb_free_pollfds(all);
  return found;
}

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

tl::unexpected<Problem> problem_from_libusb(int code, const std::string& where,
                                            const UsbHints& hints) {
  const auto error = error_from_libusb(code);
  if (error.code == ErrorCode::kNoPermission) return problem(error.code, where, kPermissionHint);
  if (error.code == ErrorCode::kDisconnected) {
    return problem(error.code, where, "was it unplugged just now?");
  }
  if (error.code == ErrorCode::kBusy) return problem(error.code, where, std::string{hints.busy});
  return problem(error.code, where, libusb_error_name(code));
}

Outcome<OpenUsb> open_usb(const UsbChoice& choice, const std::string& where,
                          const UsbHints& hints) {
  libusb_context* made = nullptr;
  if (const int code = libusb_init(&made); code != 0) {
    return problem_from_libusb(code, where, hints);
  }
  OpenUsb device{.context = decltype(OpenUsb::context){made}};
  Refused refused;
  auto candidates = open_all(made, choice, refused);
  if (candidates.empty() && refused.code != 0) return problem_of_refused(refused, where, hints);
  if (candidates.empty()) return problem(ErrorCode::kNotFound, where, std::string{hints.absent});
  if (candidates.size() > 1) {
    return problem(ErrorCode::kBadTarget, where, std::string{hints.several} + names_of(candidates));
  }
  device.handle = std::move(candidates.front().handle);
  return device;
}

std::string place_of(const OpenUsb& device) {
  return place_of(libusb_get_device(device.handle.get()));
}

}  // namespace armjig
