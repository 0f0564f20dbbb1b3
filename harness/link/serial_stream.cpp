// SPDX-License-Identifier: Apache-2.0
#include "harness/link/serial_stream.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <libserialport.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <climits>
#include <filesystem>
#include <system_error>
#include <utility>

#include "harness/link/descriptor.hpp"

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

/// A port that libserialport has set up; it shares its lock and its modes with no other open file.
class SerialStream final : public StreamPort {
 public:
  explicit SerialStream(Descriptor port) noexcept : port_{std::move(port)} {}

  Result<void> write(Bytes bytes) override {
    auto written = write_all(port_, bytes, clock_, kWritePatience);
    if (!written) return tl::unexpected{in_use(written.error())};
    return written;
  }

  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    if (into.empty()) return 0;
    while (true) {
      const auto is_ready = wait_for(port_, Readiness::kReadable, clock_, deadline);
      if (!is_ready) return tl::unexpected{is_ready.error()};
      if (!*is_ready) return 0;
      // libserialport lets `read` answer 0 when nothing has come; but something has, so it is gone.
      const auto size = ::read(port_.value(), into.data(), into.size());
      if (size > 0) return static_cast<std::size_t>(size);
      if (size == 0) return fail(ErrorCode::kDisconnected);
      if (errno != EAGAIN && errno != EINTR) {
        return tl::unexpected{in_use(error_from_errno(errno))};
      }
    }
  }

  [[nodiscard]] Instant now() const override { return clock_.now(); }

  [[nodiscard]] std::optional<int> descriptor() const override { return port_.value(); }

 private:
  /// A port that was there and is not any more was unplugged.
  static Error in_use(Error error) noexcept {
    if (error.code == ErrorCode::kNotFound) error.code = ErrorCode::kDisconnected;
    return error;
  }

  Descriptor port_;
  Stopwatch clock_;
};

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

auto not_a_serial_port(const std::string& path) {
  std::error_code ignored;
  const bool is_pty = fs::canonical(path, ignored).native().starts_with("/dev/pts/");
  return problem(ErrorCode::kBadTarget, path,
                 is_pty ? fmt::format("it is a pseudo-terminal: write pty:{}", path)
                        : "it is not a serial port; 'armjig devices' lists them");
}

tl::unexpected<Problem> problem_of_open(const std::string& path, int error_number) {
  const auto error = error_from_errno(error_number);
  switch (error.code) {
    case ErrorCode::kNotFound:
      return problem(error.code, path,
                     "is the board plugged in and switched on? 'armjig devices' lists what is");
    case ErrorCode::kNoPermission:
      return problem(error.code, path,
                     "serial ports belong to the group dialout: run 'sudo adduser $USER dialout' "
                     "and log in again; 'armjig doctor' tells more");
    case ErrorCode::kBusy:
      return problem(error.code, path,
                     "close that program, 'fuser' names it; if an armjig was killed just now, "
                     "wait a second until its arm is stopped");
    case ErrorCode::kDisconnected:
      return problem(error.code, path, "was it unplugged just now?");
    default:
      return problem(ErrorCode::kSystem, path, std::generic_category().message(error_number));
  }
}

tl::unexpected<Problem> problem_of_set_up(const SerialAddress& address, int error_number) {
  if (error_number != EINVAL && error_number != ENOTSUP) {
    return problem_of_open(address.path, error_number);
  }
  return problem(ErrorCode::kUnsupported, address.path,
                 fmt::format("it cannot be set to {} baud", address.baud));
}

/// 8N1 without flow control; DTR and RTS on, without which some boards stay silent.
sp_return configure(sp_port* port, std::uint32_t baud) noexcept {
  sp_port_config* made = nullptr;
  if (const auto answer = ::sp_new_config(&made); answer != SP_OK) return answer;
  const std::unique_ptr<sp_port_config, FreeConfig> config{made};
  ::sp_set_config_baudrate(made, static_cast<int>(baud));
  ::sp_set_config_bits(made, 8);
  ::sp_set_config_parity(made, SP_PARITY_NONE);
  ::sp_set_config_stopbits(made, 1);
  ::sp_set_config_flowcontrol(made, SP_FLOWCONTROL_NONE);
  return ::sp_set_config(port, made);
}

/// Answers an errno, 0 for success. The modes belong to the port and stay; the library's file is
/// closed again.
int set_up(sp_port* port, std::uint32_t baud) noexcept {
  if (const auto answer = ::sp_open(port, SP_MODE_READ_WRITE); answer != SP_OK) {
    return errno_of(answer);
  }
  const int error_number = errno_of(configure(port, baud));
  int file = -1;
  ::sp_get_port_handle(port, &file);
  ::ioctl(file, TIOCEXCL);  // until it is closed nobody else may open it, but for root
  ::sp_flush(port, SP_BUF_INPUT);
  ::sp_close(port);
  return error_number;
}

}  // namespace

std::string to_string(UsbId id) { return fmt::format("{:04x}:{:04x}", id.vendor, id.product); }

Result<UsbId> parse_usb_id(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) return fail(ErrorCode::kBadValue);
  const auto number = [](std::string_view digits) -> std::optional<std::uint16_t> {
    std::uint16_t value{};
    const auto* const end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, value, 16);
    if (digits.size() > 4 || error != std::errc{} || stop != end) return std::nullopt;
    return value;
  };
  const auto vendor = number(text.substr(0, colon));
  const auto product = number(text.substr(colon + 1));
  if (!vendor || !product) return fail(ErrorCode::kBadValue);
  return UsbId{*vendor, *product};
}

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

Outcome<SerialAddress> parse_serial_address(std::string_view text) {
  SerialAddress address;
  const auto comma = text.rfind(',');
  address.path = text.substr(0, comma);
  if (comma != std::string_view::npos) {
    const auto digits = text.substr(comma + 1);
    const auto* const end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, address.baud);
    const bool is_speed = address.baud > 0 && address.baud <= INT_MAX;
    if (error != std::errc{} || stop != end || !is_speed) address.path.clear();
  }
  if (!address.path.empty()) return address;
  return problem(ErrorCode::kBadTarget, fmt::format("serial:{}", text),
                 "write serial:PATH or serial:PATH,BAUD, for example serial:/dev/ttyACM0,3000000");
}

Outcome<std::unique_ptr<StreamPort>> open_serial(const SerialAddress& address) {
  const auto& path = address.path;
  // A file of our own: that of the library would be inherited by programs that we start, and it
  // has to be locked before anything about the port is changed.
  Descriptor port{::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
  if (!port.is_open()) return problem_of_open(path, errno);
  if (::isatty(port.value()) == 0) return not_a_serial_port(path);
  if (::flock(port.value(), LOCK_EX | LOCK_NB) != 0) {
    return problem_of_open(path, errno == EWOULDBLOCK ? EBUSY : errno);
  }
  sp_port* named = nullptr;
  if (::sp_get_port_by_name(kernel_name(path).c_str(), &named) != SP_OK) {
    return not_a_serial_port(path);
  }
  const PortHandle handle{named};
  if (const auto error_number = set_up(named, address.baud)) {
    return problem_of_set_up(address, error_number);
  }
  return std::make_unique<SerialStream>(std::move(port));
}

}  // namespace armjig
