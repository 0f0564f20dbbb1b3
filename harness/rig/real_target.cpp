// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/real_target.hpp"

#include <fmt/core.h>

#include "harness/link/i2c_dev.hpp"
#include "harness/link/i2c_tiny_usb.hpp"
#include "harness/link/real_streams.hpp"
#include "harness/link/rfc2217_stream.hpp"
#include "harness/link/serial_stream.hpp"
#include "harness/link/tcp_session.hpp"
#include "harness/link/usb_stream.hpp"
#include "harness/rig/attached.hpp"

namespace armjig {
namespace {

/// The path of the only serial port that the system has made of such a board.
Outcome<std::string> path_of(const UsbChoice& choice, const std::string& target) {
  auto ports = list_serial_ports();
  if (!ports) return tl::unexpected{ports.error()};
  std::erase_if(*ports, [&choice](const SerialPort& port) { return !is_meant(port, choice); });
  if (ports->size() == 1) return ports->front().path;
  if (ports->empty()) {
    return problem(ErrorCode::kNotFound, target,
                   "is the board plugged in and switched on? 'armjig devices' lists what is");
  }
  std::string all;
  for (const auto& port : *ports) {
    all += fmt::format("{}serial:{}", all.empty() ? "" : " or ", port.path);
  }
  return bad_target(target, "there are several of them: write " + all);
}

Outcome<std::unique_ptr<StreamPort>> open_serial_target(const Target& target,
                                                        const SerialLine& line) {
  auto address = parse_serial_address(target.address, line);
  if (!address) return tl::unexpected{address.error()};
  if (const auto board = parse_usb_board(address->path)) {
    auto path = path_of(*board, target.text);
    if (!path) return tl::unexpected{path.error()};
    address->path = *std::move(path);
  }
  return open_serial(*address);
}

}  // namespace

template <>
Outcome<std::unique_ptr<StreamPort>> open_target(const Target& target, const SerialLine& line) {
  if (target.scheme == "pty") return open_pty(target.address, line);
  if (target.scheme == "serial") return open_serial_target(target, line);
  if (target.scheme == "usb") return open_usb_stream(target.address, line);
  if (target.scheme == "tcp") return open_tcp_stream(target.address);
  if (target.scheme == "rfc2217") return open_rfc2217(target.address, line);
  return no_target(target.text);
}

template <>
Outcome<std::unique_ptr<SessionSource>> open_target(const Target& target,
                                                    const SerialLine& /*line*/) {
  if (target.scheme == "tcp") return open_tcp_server(target.address);
  return bad_target(target.text, "a server has connections: write emulated: or tcp:HOST:PORT");
}

template <>
Outcome<std::unique_ptr<BusPort>> open_target(const Target& target, const SerialLine& /*line*/) {
  if (target.scheme == "i2c") return open_i2c_dev(target.address);
  if (target.scheme == "i2c-tiny-usb") return open_i2c_tiny_usb(target.address);
  return bad_target(target.text, "a bus is written as emulated:, i2c:/dev/i2c-N or i2c-tiny-usb:");
}

}  // namespace armjig
