// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "cli/capture_options.hpp"
#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/report_files.hpp"
#include "cli/serving.hpp"
#include "cli/settings.hpp"
#include "cli/terminal.hpp"
#include "emulators/host/host.hpp"

namespace armjig::cli {
namespace {

constexpr auto kEmulateHelp =
    "An emulated device for programs that expect a real one, in real time.\n"
    "\n"
    "  armjig emulate DEVICE                        where a device of its kind is: on a new\n"
    "                                               pseudo-terminal, its TCP port, an I2C bus\n"
    "  armjig emulate DEVICE --link /tmp/arm        the same, under a name that stays\n"
    "  armjig emulate DEVICE --tcp 4000             as a byte stream on TCP, this machine only\n"
    "  armjig emulate DEVICE --rfc2217 4001         as a serial port over Telnet (RFC 2217)\n"
    "  armjig emulate DEVICE --usb /tmp/usb.sock    as a USB device for a virtual machine "
    "(usbredir)\n"
    "  armjig emulate DEVICE --usbip 3240           as a USB device for 'usbip attach', this "
    "machine\n"
    "                                               only; a bus is behind an I2C adapter on USB\n"
    "  armjig emulate DEVICE --tcp 0 --pty --json   both, any free port, for scripts\n"
    "  armjig emulate DEVICE --set fault=NAME       a faulty one; 'conformance mutants' has names\n"
    "  armjig emulate DEVICE --check                tells what the client program does wrong\n"
    "  armjig emulate DEVICE --capture x.pcapng     records what passes, for Wireshark\n"
    "\n"
    "Lines on standard input do to the device what no client can, such as 'estop 0'; 'help' lists\n"
    "them.\n"
    "\n"
    "Each line on standard output names a place where the device listens, in the form that\n"
    "--target takes (but usbredir: and usbip:, which are for other programs). Clients may come and "
    "go. Ctrl-C "
    "(or SIGTERM) ends it, with exit code 0:\n"
    "that is how a server ends. With --check what the program does wrong is said at once on\n"
    "standard error, and at the end as a report on standard output; findings exit with 1.";

struct EmulateOptions {
  std::string device;
  std::vector<std::string> settings;
  bool wants_pty = false;
  PtyOptions pty;
  bool wants_tcp = false;
  TcpOptions tcp;
  bool wants_rfc2217 = false;
  std::uint16_t rfc2217_port = 0;
  std::string usb_socket;
  std::optional<std::uint16_t> usbip_port;
  std::string usb_serial;  ///< its number; empty: the usual one
  int bus = 1;
  double speed = 1;
  bool wants_json = false;
  bool wants_check = false;
  CaptureOptions capture;
  ReportFiles files;
  std::string colour;
};

/// The places where a USB device is wanted.
std::vector<UsbOptions> usb_of(const EmulateOptions& options, usb::Identity identity) {
  if (!options.usb_serial.empty()) identity.serial_number = options.usb_serial;
  std::vector<UsbOptions> all;
  if (!options.usb_socket.empty()) all.push_back({identity, UsbredirSocket{options.usb_socket}});
  if (options.usbip_port) all.push_back({identity, UsbipPort{*options.usbip_port}});
  return all;
}

/// What a string of a USB device may be.
CLI::Validator usb_text() {
  return CLI::Validator{[](const std::string& text) -> std::string {
                          const bool is_printable =
                              std::ranges::all_of(text, [](char c) { return c > ' ' && c <= '~'; });
                          const bool fits = text.size() <= usb::kLongestText;
                          return is_printable && fits
                                     ? ""
                                     : fmt::format("has to be at most {} visible ASCII characters",
                                                   usb::kLongestText);
                        },
                        ""};
}

// How a device is served depends on its kind of port.

Outcome<HostOptions> how_to_serve(const OnStream& kind, const EmulateOptions& options,
                                  const Device& device) {
  auto host = server_options();
  host.usb = usb_of(options, usb_identity(device, kind.usb));
  const bool is_elsewhere = options.wants_tcp || options.wants_rfc2217 || !host.usb.empty();
  if (options.wants_pty || !options.pty.link.empty() || !is_elsewhere) host.pty = options.pty;
  if (options.wants_tcp) host.tcp = options.tcp;
  if (options.wants_rfc2217) {
    host.rfc2217 =
        TcpOptions{options.tcp.address, options.rfc2217_port, TcpOptions::Protocol::kRfc2217};
  }
  host.speed = options.speed;
  return host;
}

Outcome<HostOptions> how_to_serve(const OnServer& kind, const EmulateOptions& options,
                                  const Device& /*device*/) {
  if (options.wants_pty || !options.pty.link.empty() || options.wants_rfc2217 ||
      !usb_of(options, {}).empty()) {
    return problem(ErrorCode::kUnsupported, options.device,
                   "it is a TCP server and has no pseudo-terminal, serial port or USB; leave out "
                   "--pty, --link, --rfc2217, --usb, --usbip");
  }
  auto host = server_options();
  host.tcp = options.tcp;
  if (!options.wants_tcp) host.tcp->port = kind.tcp_port;
  host.speed = options.speed;
  return host;
}

Outcome<HostOptions> how_to_serve(const OnBus& /*kind*/, const EmulateOptions& options,
                                  const Device& device) {
  if (options.wants_pty || !options.pty.link.empty() || options.wants_tcp ||
      options.wants_rfc2217 || options.speed != 1) {
    return problem(ErrorCode::kUnsupported, options.device,
                   "a bus takes --set, --bus, --usb, --usbip, --json and --check, what --capture "
                   "needs, and no "
                   "other option");
  }
  auto host = server_options();
  host.usb = usb_of(options, usb_identity(device, std::nullopt));
  return host;
}

Exit emulate(Devices devices, const EmulateOptions& options) {
  const auto settings = parse_settings(options.settings);
  if (!settings) return report(settings.error());
  const auto found = find_device(devices, options.device);
  if (!found) return report(found.error());
  const auto& device = **found;
  const auto check = check_if(options.wants_check, device, options.speed);
  if (!check) return report(check.error());
  const auto files = ReportOutputs::open(options.files, options.wants_json ? "--json" : "");
  if (!files) return report(files.error());
  const auto file = open_capture_file("--capture", options.capture);
  if (!file) return report(file.error());
  // Only real time can be told as a time of day.
  const auto epoch_ns = options.speed == 1 ? epoch_of({}) : 0;
  auto capture = HostedCapture::open(*file, device, target_of(*settings), epoch_ns);
  if (!capture) return report(capture.error());
  const auto served = std::visit(
      [&](const auto& kind) -> Outcome<void> {
        auto emulated = cli::emulate(kind, *settings, options.device);
        if (!emulated) return tl::unexpected{emulated.error()};
        auto hosted = capture->watch(*std::move(emulated));
        if (*check) hosted = (*check)->watch(std::move(hosted));
        auto how = how_to_serve(kind, options, device);
        if (!how) return tl::unexpected{how.error()};
        return serve(std::move(hosted),
                     {options.device, *std::move(how), options.bus, options.wants_json});
      },
      device.port);
  if (!served) return report(served.error());
  return *check ? conclude(**check, options.wants_json, options.colour, *files) : Exit::kPassed;
}

}  // namespace

void add_emulate(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("emulate", with_example(kEmulateHelp, devices));
  const auto options = std::make_shared<EmulateOptions>();
  add_device_argument(*command, options->device, devices);
  command->add_flag("--pty", options->wants_pty, "on a pseudo-terminal (the default)");
  command
      ->add_option("--link", options->pty.link,
                   "a name that stays for the pseudo-terminal; removed at the end")
      ->type_name("PATH");
  auto* tcp = command->add_option("--tcp", options->tcp.port, "on this TCP port; 0: any free one")
                  ->type_name("PORT")
                  ->transform(whole(0, 65535));
  auto* rfc2217 = command
                      ->add_option("--rfc2217", options->rfc2217_port,
                                   "as a serial port over Telnet on this TCP port; 0: any free one")
                      ->type_name("PORT")
                      ->transform(whole(0, 65535));
  auto* bind = command
                   ->add_option("--bind", options->tcp.address,
                                "address for --tcp and --rfc2217 (default: 127.0.0.1)")
                   ->type_name("ADDRESS");
  command
      ->add_option("--usb", options->usb_socket,
                   "as a USB device for clients of usbredir, such as QEMU, on this UNIX socket")
      ->type_name("SOCKET");
  command
      ->add_option("--usbip", options->usbip_port,
                   "as a USB device for 'usbip attach' on this port of 127.0.0.1; 0: any free one")
      ->type_name("PORT")
      ->transform(whole(0, 65535));
  auto* usb_serial =
      command
          ->add_option("--usb-serial", options->usb_serial,
                       "its serial number on USB, by which boards of a kind are told "
                       "apart (default: DEVICE-emulated)")
          ->type_name("TEXT")
          ->check(usb_text());
  command
      ->add_option("--speed", options->speed,
                   "device time over wall time, 0.001 to 10000 (default: 1)")
      ->type_name("FACTOR")
      ->check(number(0.001, 10'000));
  command
      ->add_option("--set", options->settings,
                   "an option of the device, as in emulated: targets; may be repeated")
      ->type_name("NAME=VALUE");
  command->add_option("--bus", options->bus, "the N of /dev/i2c-N, 0 to 255 (default: 1)")
      ->type_name("N")
      ->transform(whole(0, 255));
  command->add_flag("--json", options->wants_json,
                    "say where it listens as one line of JSON; the report of --check too");
  add_capture_options(*command, options->capture);
  add_program_check(*command, options->wants_check, options->files, options->colour);
  command->callback([options, tcp, rfc2217, bind, usb_serial, devices, &action] {
    options->wants_tcp = tcp->count() > 0;
    options->wants_rfc2217 = rfc2217->count() > 0;
    if (bind->count() > 0 && !options->wants_tcp && !options->wants_rfc2217) {
      throw CLI::RequiresError{"--bind", "--tcp or --rfc2217"};
    }
    const bool is_on_usb = !options->usb_socket.empty() || options->usbip_port;
    if (usb_serial->count() > 0 && !is_on_usb) {
      throw CLI::RequiresError{"--usb-serial", "--usb or --usbip"};
    }
    action = [options, devices] { return emulate(devices, *options); };
  });
}

}  // namespace armjig::cli
