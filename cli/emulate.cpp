// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/emulate_bus.hpp"
#include "emulators/host/buses.hpp"
#include "emulators/host/devices.hpp"
#include "emulators/host/host.hpp"

namespace armjig::cli {
namespace {

constexpr auto kHelp =
    "An emulated device for programs that expect a real one, in real time.\n"
    "\n"
    "  armjig emulate parol6                        on a new pseudo-terminal\n"
    "  armjig emulate parol6 --link /tmp/parol6     the same, under a name that stays\n"
    "  armjig emulate parol6 --tcp 4000             as a byte stream on TCP, this machine only\n"
    "  armjig emulate parol6 --tcp 0 --pty --json   both, any free port, for scripts\n"
    "  armjig emulate parol6 --set fault=swap-bytes:speed.j1   a faulty one\n"
    "  armjig emulate morap --set nodes=1,2 --set bus=1        nodes on a virtual /dev/i2c-1\n"
    "\n"
    "Each line on standard output names a place where the device listens, in the form that\n"
    "--target takes. Clients may come and go. Ctrl-C (or SIGTERM) ends it, with exit code 0:\n"
    "that is how a server ends.";

struct Options {
  std::string device;
  std::vector<std::string> settings;
  bool wants_pty = false;
  PtyOptions pty;
  bool wants_tcp = false;
  TcpOptions tcp;
  double speed = 1;
  bool wants_json = false;
};

std::string all_devices() {
  std::string names;
  for (const auto& entry : hosted_devices()) {
    if (!names.empty()) names += ", ";
    names += entry.device;
  }
  for (const auto& entry : hosted_buses()) names += ", " + std::string{entry.device};
  return names;
}

HostOptions host_options(const Options& options) {
  HostOptions host;
  if (options.wants_pty || !options.pty.link.empty() || !options.wants_tcp) host.pty = options.pty;
  if (options.wants_tcp) host.tcp = options.tcp;
  host.speed = options.speed;
  host.on_signal = HostOptions::OnSignal::kStop;
  host.log = [](std::string_view line) { fmt::print(stderr, "armjig: {}\n", line); };
  return host;
}

void announce(const Options& options, const std::vector<std::string>& targets) {
  if (options.wants_json) {
    const nlohmann::ordered_json line{{"schema", "armjig.emulate/1"},
                                      {"device", options.device},
                                      {"listening", targets},
                                      {"pid", ::getpid()}};
    fmt::print("{}\n", line.dump());
  } else {
    const auto link = options.pty.link.empty() ? targets.size() : std::size_t{1};
    for (std::size_t i = 0; i < targets.size(); ++i) {
      fmt::print("listening {}{}\n", targets[i], i == link ? " (link)" : "");
    }
  }
  std::fflush(stdout);  // whoever waits for the line may be behind a pipe
}

void print_statistics(const HostStatistics& statistics) {
  const auto& links = statistics.links;
  fmt::print(stderr,
             "armjig: {} clients served, {} refused; {} bytes in, {} bytes out, {} frames "
             "dropped\n",
             links.clients, links.refused, links.bytes_in, links.bytes_out, links.frames_dropped);
  if (statistics.lost > Duration::zero()) {
    fmt::print(stderr, "armjig: this machine is too slow: {:.3f} s of device time were lost\n",
               std::chrono::duration<double>{statistics.lost}.count());
  }
}

Outcome<DeviceOptions> parse_settings(const std::vector<std::string>& settings) {
  DeviceOptions options;
  for (const auto& setting : settings) {
    const auto equals = setting.find('=');
    if (equals == 0 || equals == std::string::npos) {
      return problem(ErrorCode::kBadValue, "--set " + setting, "write NAME=VALUE");
    }
    options[setting.substr(0, equals)] = setting.substr(equals + 1);
  }
  return options;
}

Exit emulate(const Options& options) {
  const auto settings = parse_settings(options.settings);
  if (!settings) return report(settings.error());
  if (const auto* bus = find_hosted_bus(options.device)) {
    return emulate_bus(*bus, *settings,
                       options.wants_json ? Announcement::kJson : Announcement::kText);
  }
  auto device = make_hosted_device(options.device, *settings);
  if (!device) return report(device.error());
  auto host = Host::open(std::move(*device), host_options(options));
  if (!host) return report(host.error());
  announce(options, host->targets());
  host->run();
  print_statistics(host->statistics());
  return Exit::kPassed;
}

}  // namespace

void add_emulate(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("emulate", kHelp);
  const auto options = std::make_shared<Options>();
  command->add_option("DEVICE", options->device, "what to emulate: " + all_devices())
      ->required()
      ->type_name("");
  command->add_flag("--pty", options->wants_pty, "on a pseudo-terminal (the default)");
  command
      ->add_option("--link", options->pty.link,
                   "a name that stays for the pseudo-terminal; removed at the end")
      ->type_name("PATH");
  auto* tcp = command->add_option("--tcp", options->tcp.port, "on this TCP port; 0: any free one")
                  ->type_name("PORT")
                  ->check(CLI::Range(0, 65535));
  command->add_option("--bind", options->tcp.address, "address for --tcp (default: 127.0.0.1)")
      ->type_name("ADDRESS")
      ->needs(tcp);
  command
      ->add_option("--speed", options->speed,
                   "device time over wall time, 0.001 to 10000 (default: 1)")
      ->type_name("FACTOR");
  command
      ->add_option("--set", options->settings,
                   "an option of the device, as in emulated: targets; may be repeated")
      ->type_name("NAME=VALUE");
  command->add_flag("--json", options->wants_json, "say where it listens as one line of JSON");
  command->callback([options, tcp, &action] {
    options->wants_tcp = tcp->count() > 0;
    action = [options] { return emulate(*options); };
  });
}

}  // namespace armjig::cli
