// SPDX-License-Identifier: Apache-2.0
#include "harness/link/serial_stream.hpp"

#include <fmt/core.h>
#include <libserialport.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "harness/core/number.hpp"
#include "harness/link/descriptor.hpp"
#include "harness/link/terminal_settings.hpp"

namespace armjig {
namespace {

namespace fs = std::filesystem;

struct FreePort {
  void operator()(sp_port* port) const noexcept { ::sp_free_port(port); }
};
struct FreeList {
  void operator()(sp_port** list) const noexcept { ::sp_free_port_list(list); }
};
struct FreeConfig {
  void operator()(sp_port_config* config) const noexcept { ::sp_free_config(config); }
};
using PortHandle = std::unique_ptr<sp_port, FreePort>;

/// The errno behind what libserialport has just answered.
int errno_of(sp_return answer) noexcept {
  switch (answer) {
    case SP_OK:
      return 0;
    case SP_ERR_ARG:
      return EINVAL;
    case SP_ERR_MEM:
      return ENOMEM;
    case SP_ERR_SUPP:
      return ENOTSUP;
    case SP_ERR_FAIL:
      break;
  }
  return ::sp_last_error_code();
}

std::string text_or_empty(const char* text) { return text == nullptr ? std::string{} : text; }

SerialPort description_of(const sp_port* port) {
  SerialPort found;
  found.path = text_or_empty(::sp_get_port_name(port));
  found.description = text_or_empty(::sp_get_port_description(port));
  if (::sp_get_port_transport(port) != SP_TRANSPORT_USB) return found;
  int vendor = 0;
  int product = 0;
  if (::sp_get_port_usb_vid_pid(port, &vendor, &product) == SP_OK) {
    found.usb = UsbId{static_cast<std::uint16_t>(vendor), static_cast<std::uint16_t>(product)};
  }
  found.manufacturer = text_or_empty(::sp_get_port_usb_manufacturer(port));
  found.product = text_or_empty(::sp_get_port_usb_product(port));
  found.serial_number = text_or_empty(::sp_get_port_usb_serial(port));
  return found;
}

/// libserialport knows ports by the names that the kernel gives them. The name to which the links
/// at `path` lead; `path` itself if they lead to none.
std::string kernel_name(const std::string& path) {
  constexpr int kMostLinks = 40;  // as many as the kernel follows
  fs::path name{path};
  std::error_code error;
  for (int i = 0; i < kMostLinks; ++i) {
    if (fs::exists("/sys/class/tty" / name.filename(), error)) return name;
    const auto next = fs::read_symlink(name, error);
    if (error) break;
    name = (name.parent_path() / next).lexically_normal();
  }
  return path;
}

bool is_pseudo_terminal(const std::string& path) {
  constexpr unsigned kFirstMajor = 136;  // Linux, Documentation/admin-guide/devices.txt
  constexpr unsigned kLastMajor = 143;
  struct stat status{};
  if (::stat(path.c_str(), &status) != 0 || !S_ISCHR(status.st_mode)) return false;
  const auto kind = major(status.st_rdev);
  return kind >= kFirstMajor && kind <= kLastMajor;
}

tl::unexpected<Problem> problem_of_port(const std::string& path, const Error& error) {
  return problem_of_open(
      path, error,
      {.absent = "is the board plugged in and switched on? 'armjig devices' lists what is",
       .not_allowed = "serial ports belong to the group dialout: run 'sudo adduser $USER dialout' "
                      "and log in again, or let 60-armjig.rules do it, which 'armjig doctor "
                      "--udev-rules' prints",
       .busy = "close that program, 'fuser' names it; if an armjig was killed just now, wait a "
               "second until its arm is stopped",
       .gone = "was it unplugged just now?",
       .wrong_kind = is_pseudo_terminal(path)
                         ? fmt::format("it is a pseudo-terminal: write pty:{}", path)
                         : "it is not a serial port; 'armjig devices' lists them"});
}

tl::unexpected<Problem> problem_of_set_up(const SerialAddress& address, int error_number) {
  if (error_number != EINVAL && error_number != ENOTSUP) {
    return problem_of_port(address.path, error_from_errno(error_number));
  }
  return problem(
      ErrorCode::kUnsupported, address.path,
      fmt::format("it cannot be set to {} baud, {} parity and {} stop bits", address.line.baud,
                  to_string(address.line.parity), address.line.stop_bits));
}

/// 8 bits without flow control; DTR and RTS on, without which some boards stay silent.
sp_return configure(sp_port* port, const SerialLine& line) noexcept {
  constexpr std::array kParities{SP_PARITY_NONE, SP_PARITY_ODD, SP_PARITY_EVEN};
  sp_port_config* made = nullptr;
  if (const auto answer = ::sp_new_config(&made); answer != SP_OK) return answer;
  const std::unique_ptr<sp_port_config, FreeConfig> config{made};
  ::sp_set_config_baudrate(made, static_cast<int>(line.baud));
  ::sp_set_config_bits(made, 8);
  ::sp_set_config_parity(made, kParities[static_cast<std::size_t>(line.parity)]);
  ::sp_set_config_stopbits(made, line.stop_bits);
  ::sp_set_config_flowcontrol(made, SP_FLOWCONTROL_NONE);
  return ::sp_set_config(port, made);
}

/// Answers an errno, 0 for success. The modes belong to the port and stay; the library's file is
/// closed again.
int set_up(sp_port* port, const SerialLine& line) noexcept {
  if (const auto answer = ::sp_open(port, SP_MODE_READ_WRITE); answer != SP_OK) {
    return errno_of(answer);
  }
  const int error_number = errno_of(configure(port, line));
  int file = -1;
  ::sp_get_port_handle(port, &file);
  ::ioctl(file, TIOCEXCL);  // until it is closed nobody else may open it, but for root
  ::sp_flush(port, SP_BUF_INPUT);
  ::sp_close(port);
  return error_number;
}

}  // namespace

Outcome<std::vector<SerialPort>> list_serial_ports() {
  sp_port** list = nullptr;
  if (const auto answer = ::sp_list_ports(&list); answer != SP_OK) {
    const auto error_number = errno_of(answer);
    if (error_number == ENOENT) return {};  // this system does not know what a serial port is
    return problem(ErrorCode::kSystem, "serial ports",
                   std::generic_category().message(error_number));
  }
  const std::unique_ptr<sp_port*, FreeList> owner{list};
  std::vector<SerialPort> ports;
  for (; *list != nullptr; ++list) ports.push_back(description_of(*list));
  std::ranges::sort(ports, {}, &SerialPort::path);
  return ports;
}

Outcome<SerialAddress> parse_serial_address(std::string_view text, SerialLine usual) {
  SerialAddress address{.line = usual};
  const auto comma = text.rfind(',');
  address.path = text.substr(0, comma);
  if (comma != std::string_view::npos) {
    const auto baud = whole_text_as<int>(text.substr(comma + 1));
    if (baud && *baud > 0)
      address.line.baud = static_cast<std::uint32_t>(*baud);
    else
      address.path.clear();
  }
  if (!address.path.empty()) return address;
  return problem(ErrorCode::kBadTarget, fmt::format("serial:{}", text),
                 "write serial:PATH or serial:PATH,BAUD, for example serial:/dev/ttyACM0,3000000");
}

Outcome<std::unique_ptr<StreamPort>> open_serial(const SerialAddress& address) {
  const auto& path = address.path;
  // A file of our own: that of the library would be inherited by programs that we start, and it
  // has to be locked before anything about the port is changed.
  auto port = open_terminal(path);
  if (!port) return problem_of_port(path, port.error());
  if (const auto session = session_on(port->value()); session != 0) {
    return problem(ErrorCode::kBusy, path, describe_session(session) + "; end the login on it");
  }
  sp_port* named = nullptr;
  if (::sp_get_port_by_name(kernel_name(path).c_str(), &named) != SP_OK) {
    // The library asks the system, which has forgotten a port that is pulled out right now.
    const bool is_there = ::isatty(port->value()) != 0;
    return problem_of_port(path, {is_there ? ErrorCode::kBadTarget : ErrorCode::kDisconnected});
  }
  const PortHandle handle{named};
  if (const auto error_number = set_up(named, address.line)) {
    return problem_of_set_up(address, error_number);
  }
  return std::make_unique<DescriptorStream>(*std::move(port), &write_all);
}

}  // namespace armjig
