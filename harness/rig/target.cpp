// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/target.hpp"

#include <fmt/core.h>

#include <vector>

#include "harness/link/real_streams.hpp"
#include "harness/link/serial_stream.hpp"

namespace armjig {
namespace {

constexpr auto kForms =
    "write emulated:, serial:PATH, usb:VID:PID, pty:PATH or tcp:HOST:PORT; 'armjig devices' lists "
    "what is plugged in";

auto bad_target(std::string_view text, std::string_view hint) {
  return problem(ErrorCode::kBadTarget, fmt::format("'{}'", text), std::string{hint});
}

Outcome<std::unique_ptr<StreamPort>> open_serial_target(const Target& target) {
  const auto address = parse_serial_address(target.address);
  if (!address) return tl::unexpected{address.error()};
  return open_serial(*address);
}

/// The board's serial port, if there is just one of its kind.
Outcome<std::unique_ptr<StreamPort>> open_usb_target(const Target& target) {
  const auto id = parse_usb_id(target.address);
  if (!id) return bad_target(target.text, "write usb:VID:PID, for example usb:0483:5740");
  auto ports = list_serial_ports();
  if (!ports) return tl::unexpected{ports.error()};
  std::erase_if(*ports, [&id](const SerialPort& port) { return port.usb != *id; });
  if (ports->empty()) {
    return problem(ErrorCode::kNotFound, target.text,
                   "is the board plugged in and switched on? 'armjig devices' lists what is");
  }
  if (ports->size() == 1) return open_serial({.path = ports->front().path});
  std::string all;
  for (const auto& port : *ports) {
    all += fmt::format("{}serial:{}", all.empty() ? "" : " or ", port.path);
  }
  return bad_target(target.text, "there are several of them: write " + all);
}

}  // namespace

Outcome<Target> parse_target(std::string_view text) {
  Target target;
  target.text = text;
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) return bad_target(text, kForms);
  target.scheme = text.substr(0, colon);
  auto rest = text.substr(colon + 1);
  // Only emulated targets have options; a path or host may contain a question mark.
  const auto question = target.is_emulated() ? rest.find('?') : std::string_view::npos;
  target.address = rest.substr(0, question);
  rest = question == std::string_view::npos ? "" : rest.substr(question + 1);
  while (!rest.empty()) {
    const auto end = rest.find('&');
    const auto option = rest.substr(0, end);
    const auto equals = option.find('=');
    if (equals == 0 || equals == std::string_view::npos) {
      return bad_target(text, "write options as ?NAME=VALUE&NAME=VALUE");
    }
    target.options[std::string{option.substr(0, equals)}] = option.substr(equals + 1);
    rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
  }
  if (target.is_emulated() && !target.address.empty()) {
    return bad_target(text, "emulated: has no address, only ?NAME=VALUE options");
  }
  return target;
}

Outcome<std::unique_ptr<StreamPort>> open_stream(const Target& target, OpenEmulated open_emulated) {
  if (target.is_emulated()) return open_emulated(target);
  if (target.scheme == "pty") return open_pty(target.address);
  if (target.scheme == "serial") return open_serial_target(target);
  if (target.scheme == "usb") return open_usb_target(target);
  if (target.scheme == "tcp") return open_tcp_stream(target.address);
  return bad_target(target.text, kForms);
}

}  // namespace armjig
