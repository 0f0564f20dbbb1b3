// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cli/capture_options.hpp"
#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/presented.hpp"
#include "cli/report_files.hpp"
#include "cli/serving.hpp"
#include "cli/settings.hpp"
#include "cli/terminal.hpp"

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
  Places places;  ///< but for the pseudo-terminal
  int bus = 1;
  double speed = 1;
  bool wants_json = false;
  bool wants_check = false;
  CaptureOptions capture;
  ReportFiles files;
  std::string colour;
};

// Where a device is served depends on its kind of port.

Outcome<Places> places_of(const OnStream& /*kind*/, const EmulateOptions& options) {
  auto places = options.places;
  const bool is_elsewhere = places.tcp || places.rfc2217 || places.is_on_usb();
  if (options.wants_pty || !options.pty.link.empty() || !is_elsewhere) places.pty = options.pty;
  return places;
}

Outcome<Places> places_of(const OnServer& kind, const EmulateOptions& options) {
  auto places = options.places;
  if (options.wants_pty || !options.pty.link.empty() || places.rfc2217 || places.is_on_usb()) {
    return problem(ErrorCode::kUnsupported, options.device,
                   "it is a TCP server and has no pseudo-terminal, serial port or USB; leave out "
                   "--pty, --link, --rfc2217, --usb, --usbip");
  }
  if (!places.tcp) places.tcp = kind.tcp_port;
  return places;
}

Outcome<Places> places_of(const OnBus& /*kind*/, const EmulateOptions& options) {
  auto places = options.places;
  if (options.wants_pty || !options.pty.link.empty() || places.tcp || places.rfc2217 ||
      options.speed != 1) {
    return problem(ErrorCode::kUnsupported, options.device,
                   "a bus takes --set, --bus, --usb, --usbip, --json and --check, what --capture "
                   "needs, and no "
                   "other option");
  }
  if (!places.is_on_usb()) places.bus = options.bus;
  return places;
}

Exit emulate(Devices devices, const EmulateOptions& options) {
  const auto settings = parse_settings(options.settings);
  if (!settings) return report(settings.error());
  const auto found = find_device(devices, options.device);
  if (!found) return report(found.error());
  const auto& device = **found;
  const auto check = check_if(options.wants_check, device, options.speed);
  if (!check) return report(check.error());
  const auto places =
      std::visit([&](const auto& kind) { return places_of(kind, options); }, device.port);
  if (!places) return report(places.error());
  const auto files = ReportOutputs::open(options.files, options.wants_json ? "--json" : "");
  if (!files) return report(files.error());
  const auto file = open_capture_file("--capture", options.capture);
  if (!file) return report(file.error());
  const Target target{target_of(*settings), "emulated", {}, *settings};
  const auto presented = Presented::open(
      device, {.target = target, .capture = *file, .speed = options.speed, .check = check->get()});
  if (!presented) return report(presented.error());
  std::vector<ToServe> served;
  served.push_back(
      {(*presented)->take(), serving_at(device, options.device, *places, options.speed)});
  const auto done = serve(std::move(served), {.wants_json = options.wants_json});
  if (!done) return report(done.error());
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
  command->add_option("--tcp", options->places.tcp, "on this TCP port; 0: any free one")
      ->type_name("PORT")
      ->transform(whole(0, 65535));
  command
      ->add_option("--rfc2217", options->places.rfc2217,
                   "as a serial port over Telnet on this TCP port; 0: any free one")
      ->type_name("PORT")
      ->transform(whole(0, 65535));
  auto* bind = command
                   ->add_option("--bind", options->places.bind,
                                "address for --tcp and --rfc2217 (default: 127.0.0.1)")
                   ->type_name("ADDRESS");
  command
      ->add_option("--usb", options->places.usb_socket,
                   "as a USB device for clients of usbredir, such as QEMU, on this UNIX socket")
      ->type_name("SOCKET");
  command
      ->add_option("--usbip", options->places.usbip,
                   "as a USB device for 'usbip attach' on this port of 127.0.0.1; 0: any free one")
      ->type_name("PORT")
      ->transform(whole(0, 65535));
  auto* usb_serial =
      command
          ->add_option("--usb-serial", options->places.usb_serial,
                       "its serial number on USB, by which boards of a kind are told "
                       "apart (default: DEVICE-emulated)")
          ->type_name("TEXT")
          ->check(CLI::Validator{[](const std::string& text) {
                                   return is_usb_text(text) ? ""
                                                            : fmt::format("has to be {}", kUsbText);
                                 },
                                 ""});
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
  command->callback([options, bind, usb_serial, devices, &action] {
    const auto& places = options->places;
    if (bind->count() > 0 && !places.tcp && !places.rfc2217) {
      throw CLI::RequiresError{"--bind", "--tcp or --rfc2217"};
    }
    if (usb_serial->count() > 0 && !places.is_on_usb()) {
      throw CLI::RequiresError{"--usb-serial", "--usb or --usbip"};
    }
    action = [options, devices] { return emulate(devices, *options); };
  });
}

}  // namespace armjig::cli
