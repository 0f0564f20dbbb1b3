// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/device.hpp"
#include "harness/rig/attached.hpp"

namespace armjig::cli {
namespace {

constexpr auto kDevicesHelp =
    "Lists the serial ports of this machine, and what they look like.\n"
    "\n"
    "  armjig devices                                   what to write behind --target\n"
    "  armjig devices --json                            the same for scripts\n"
    "\n"
    "Nothing is opened. A board is told by its USB numbers, so others with the same chip look "
    "like\n"
    "it. What 'armjig emulate' serves is not listed.";

void print_table(const std::vector<SerialPort>& ports, std::span<const KnownBoard> boards) {
  for (const auto& port : ports) {
    const auto device = device_behind(port, boards);
    const bool may_open = access_to(port.path) == FileAccess::kAllowed;
    fmt::print("{:<24} {:<8} {:<10} {}{}\n", target_of(port), device.empty() ? "-" : device,
               port.usb ? to_string(*port.usb) : "-", describe(port),
               may_open ? "" : "; you may not open it, see 'armjig doctor'");
  }
}

nlohmann::ordered_json to_json(const SerialPort& port, std::span<const KnownBoard> boards) {
  using Json = nlohmann::ordered_json;
  const auto device = device_behind(port, boards);
  return Json{{"target", target_of(port)},
              {"path", port.path},
              {"device", device.empty() ? Json{} : Json{device}},
              {"usb", port.usb ? Json{to_string(*port.usb)} : Json{}},
              {"manufacturer", port.manufacturer},
              {"product", port.product},
              {"serial_number", port.serial_number},
              {"description", port.description},
              {"may_open", access_to(port.path) == FileAccess::kAllowed}};
}

void print_json(const std::vector<SerialPort>& ports, std::span<const KnownBoard> boards) {
  nlohmann::ordered_json json{{"schema", "armjig.devices/1"},
                              {"ports", nlohmann::ordered_json::array()}};
  for (const auto& port : ports) json["ports"].push_back(to_json(port, boards));
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

Exit devices(Devices devices, bool wants_json) {
  const auto boards = known_boards(devices);
  const auto ports = list_serial_ports();
  if (!ports) return report(ports.error());
  if (wants_json) {
    print_json(*ports, boards);
  } else {
    print_table(*ports, boards);
    if (ports->empty()) {
      fmt::print(stderr,
                 "armjig: no serial port is plugged in; without a board: armjig emulate {}\n",
                 devices.front().name);
    }
  }
  return Exit::kPassed;
}

}  // namespace

void add_devices(CLI::App& app, Devices known, Action& action) {
  auto* command = app.add_subcommand("devices", kDevicesHelp);
  const auto wants_json = std::make_shared<bool>(false);
  command->add_flag("--json", *wants_json, "as one JSON object");
  when_chosen(*command, action, [wants_json, known] { return devices(known, *wants_json); });
}

}  // namespace armjig::cli
