// SPDX-License-Identifier: Apache-2.0
#include "cli/foreign_options.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "cli/device.hpp"
#include "harness/report/wording.hpp"

namespace armjig::cli {
namespace {

template <class Number>
std::optional<Number> whole_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

ForeignDevice foreign_device(const Device& device) {
  ForeignDevice foreign{.name = std::string{device.name}, .make_dissector = device.make_dissector};
  foreign.kind = std::holds_alternative<OnServer>(device.port) ? LinkKind::kSession
                 : std::holds_alternative<OnBus>(device.port)  ? LinkKind::kBus
                                                               : LinkKind::kStream;
  if (const auto* const stream = std::get_if<OnStream>(&device.port)) {
    foreign.is_usb = stream->usb.has_value();
  }
  return foreign;
}

Outcome<ForeignPort> parse_port(const std::string& text, Devices devices, std::string_view device) {
  const auto equals = text.find('=');
  const auto port = whole_number<std::uint16_t>(std::string_view{text}.substr(0, equals));
  const auto bad = [&text](const char* hint) {
    return problem(ErrorCode::kBadValue, "--tcp-port " + text, hint);
  };
  if (!port || *port == 0) return bad("write PORT or PORT=DEVICE, with a port from 1 to 65535");
  if (equals != std::string::npos) device = std::string_view{text}.substr(equals + 1);
  if (device.empty()) return bad("write PORT=DEVICE");
  const auto found = find_device(devices, device);
  if (!found) return tl::unexpected{found.error()};
  if (std::holds_alternative<OnBus>((*found)->port)) return bad("a bus is not reached over TCP");
  return ForeignPort{*port, static_cast<std::size_t>(*found - devices.data())};
}

Outcome<UsbPlace> parse_usb(const std::string& text) {
  const auto dot = text.find('.');
  const std::string_view view{text};
  const auto bus = whole_number<std::uint32_t>(view.substr(0, dot));
  const auto device =
      dot == std::string::npos ? std::nullopt : whole_number<std::uint32_t>(view.substr(dot + 1));
  if (bus && device) return UsbPlace{*bus, *device};
  return problem(ErrorCode::kBadValue, "--usb " + text, "write BUS.DEVICE, as in 1.4 (lsusb)");
}

}  // namespace

void add_foreign_options(CLI::App& command, ForeignOptions& options) {
  command
      .add_option("--tcp-port", options.ports,
                  "of another program's recording: who listens there; may be repeated")
      ->type_name("PORT[=DEVICE]");
  command
      .add_option("--usb", options.usb,
                  "of a recording of usbmon: the board; without it, by what is said")
      ->type_name("BUS.DEVICE");
}

Outcome<ForeignHow> foreign_how(Devices devices, const ForeignOptions& options,
                                std::string_view device) {
  ForeignHow how;
  std::vector<std::string_view> servers;
  for (const auto& one : devices) {
    how.devices.push_back(foreign_device(one));
    if (std::holds_alternative<OnServer>(one.port)) servers.push_back(one.name);
  }
  if (device.empty() && servers.size() == 1) device = servers.front();
  for (const auto& text : options.ports) {
    const auto port = parse_port(text, devices, device);
    if (!port) return tl::unexpected{port.error()};
    how.ports.push_back(*port);
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const auto* const server = std::get_if<OnServer>(&devices[i].port);
    if (server != nullptr && server->tcp_port != 0) how.ports.push_back({server->tcp_port, i});
  }
  if (options.usb.empty()) return how;
  const auto usb = parse_usb(options.usb);
  if (!usb) return tl::unexpected{usb.error()};
  how.usb = *usb;
  return how;
}

Outcome<std::unique_ptr<CaptureReader>> open_recording(const std::string& path,
                                                       const ForeignHow& how) {
  auto file = path == "-" ? UserFile::standard_input() : UserFile::open(path);
  if (!file) return tl::unexpected{std::move(file.error())};
  return open_foreign(*std::move(file), path == "-" ? "standard input" : path, how);
}

void print_warning_of(const CaptureReader& reader) {
  const auto warning = reader.warning();
  std::size_t begin = 0;
  while (begin < warning.size()) {
    const auto end = std::min(warning.find('\n', begin), warning.size());
    fmt::print(stderr, "armjig: {}\n", wording::line(warning.substr(begin, end - begin)));
    begin = end + 1;
  }
}

}  // namespace armjig::cli
