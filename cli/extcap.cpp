// SPDX-License-Identifier: Apache-2.0
#include "cli/extcap.hpp"

#include <fmt/core.h>

#include <memory>
#include <string_view>
#include <variant>

#include "cli/device.hpp"
#include "cli/record.hpp"
#include "harness/capture/pcapng.hpp"
#include "harness/core/version.hpp"

namespace armjig::cli {
namespace {

constexpr auto kExtcapHelp =
    "What Wireshark calls, by the script that 'armjig wireshark install' makes: to ask what there\n"
    "is, and to capture. An interface is a device; a capture is 'armjig record' into Wireshark.\n"
    "\n"
    "  armjig wireshark extcap --extcap-interfaces";

constexpr std::string_view kPrefix = "armjig-";

struct ExtcapOptions {
  bool wants_interfaces = false;
  bool wants_links = false;
  bool wants_settings = false;
  bool is_capture = false;
  std::string interface;
  std::string fifo;
  std::string ignored;
  RecordOptions record;
};

void print_interfaces(Devices devices) {
  fmt::print("extcap {{version={}}}\n", kVersion);
  for (const auto& device : devices) {
    fmt::print("interface {{value={}{}}}{{display=armjig: {}}}\n", kPrefix, device.name,
               device.title);
  }
}

void print_links(const Device& device) {
  const bool is_bus = std::holds_alternative<OnBus>(device.port);
  fmt::print("dlt {{number={}}}{{name={}}}{{display={}}}\n",
             static_cast<int>(is_bus ? pcapng::kLinkI2c : pcapng::kLinkUpperPdu),
             is_bus ? "I2C_LINUX" : "WIRESHARK_UPPER_PDU", device.title);
}

/// Where programs find the device unless the user says otherwise.
std::string usual_place(const Device& device) {
  if (const auto* server = std::get_if<OnServer>(&device.port)) {
    return fmt::format("tcp:{}", server->tcp_port);
  }
  return std::holds_alternative<OnBus>(device.port) ? "i2c:1" : "pty:";
}

void print_settings(const Device& device) {
  fmt::print(
      "arg {{number=0}}{{call=--target}}{{display=Target}}{{type=string}}{{required=true}}"
      "{{default=emulated:}}{{tooltip=Where the device is, as in 'armjig record'}}\n"
      "arg {{number=1}}{{call=--listen}}{{display=Listen}}{{type=string}}{{required=true}}"
      "{{default={}}}{{tooltip=Where your program finds it: pty:PATH, tcp:[HOST:]PORT, i2c:N}}\n",
      usual_place(device));
}

Exit extcap(Devices devices, const ExtcapOptions& options) {
  if (options.wants_interfaces) {
    print_interfaces(devices);
    return Exit::kPassed;
  }
  const std::string_view interface{options.interface};
  if (!interface.starts_with(kPrefix)) {
    return report({ErrorCode::kBadValue, "--extcap-interface " + options.interface,
                   "write one that --extcap-interfaces lists"});
  }
  const auto found = find_device(devices, interface.substr(kPrefix.size()));
  if (!found) return report(found.error());
  const auto& device = **found;
  if (options.wants_links) {
    print_links(device);
  } else if (options.wants_settings) {
    print_settings(device);
  } else if (options.is_capture && !options.fifo.empty()) {
    auto record_options = options.record;
    record_options.device = device.name;
    record_options.capture.file = options.fifo;
    record_options.capture.format = CaptureFormat::kPcapng;
    record_options.is_quiet = true;  // whatever is said is an error for Wireshark
    if (record_options.listen.empty()) record_options.listen = usual_place(device);
    return record(devices, record_options);
  } else {
    return report({ErrorCode::kBadValue, "wireshark extcap",
                   "say --extcap-dlts, --extcap-config, or --capture --fifo FILE"});
  }
  return Exit::kPassed;
}

}  // namespace

void add_extcap(CLI::App& wireshark, Devices devices, Action& action) {
  auto* command = wireshark.add_subcommand("extcap", kExtcapHelp);
  const auto options = std::make_shared<ExtcapOptions>();
  command->add_flag("--extcap-interfaces", options->wants_interfaces, "lists the devices");
  command->add_flag("--extcap-dlts", options->wants_links, "what an interface's packets are");
  command->add_flag("--extcap-config", options->wants_settings, "what can be set");
  command->add_flag("--capture", options->is_capture, "records");
  command->add_option("--extcap-interface", options->interface, "which one")->type_name("NAME");
  command->add_option("--fifo", options->fifo, "where the packets go")->type_name("FILE");
  command->add_option("--extcap-version", options->ignored, "Wireshark's own")
      ->type_name("VERSION");
  command->add_option("--extcap-capture-filter", options->ignored, "there is none")
      ->type_name("FILTER");
  options->record.target = "emulated:";
  command->add_option("--target", options->record.target, "where the device is; emulated:")
      ->type_name("TARGET");
  command
      ->add_option("--listen", options->record.listen,
                   "where programs find it; pty:, the device's own TCP port, or i2c:1")
      ->type_name("PLACE");
  when_chosen(*command, action, [options, devices] { return extcap(devices, *options); });
}

std::string extcap_script(const std::string& program) {
  std::string quoted{"'"};
  for (const char one : program) quoted += one == '\'' ? std::string{R"('\'')"} : std::string{one};
  return fmt::format(
      "#!/bin/sh\n# Made by 'armjig wireshark install'.\n"
      "exec {}' wireshark extcap \"$@\"\n",
      quoted);
}

}  // namespace armjig::cli
