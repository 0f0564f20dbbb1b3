// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "cli/device_inputs.hpp"
#include "cli/emulate_bus.hpp"
#include "cli/program_judge.hpp"
#include "conformance/program_check.hpp"
#include "emulators/host/buses.hpp"
#include "emulators/host/devices.hpp"
#include "emulators/host/host.hpp"
#include "emulators/host/session_host.hpp"

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
    "  armjig emulate parol6 --check                tells what the client program does wrong\n"
    "  armjig emulate kinovazed                     a server on its own TCP port, 51717\n"
    "  armjig emulate kinovazed --tcp 0 --set objectives=my.json\n"
    "  armjig emulate kinovazed --check             the same for its clients\n"
    "\n"
    "Lines on standard input do to a board or server what no client can, such as 'estop 0' or\n"
    "'arm.plugged 0'; 'help' lists them.\n"
    "\n"
    "Each line on standard output names a place where the device listens, in the form that\n"
    "--target takes. Clients may come and go. Ctrl-C (or SIGTERM) ends it, with exit code 0:\n"
    "that is how a server ends. With --check what the program does wrong is said at once on\n"
    "standard error, and at the end as a report on standard output; findings exit with 1.";

struct Options {
  std::string device;
  std::vector<std::string> settings;
  bool wants_pty = false;
  PtyOptions pty;
  bool wants_tcp = false;
  TcpOptions tcp;
  double speed = 1;
  bool wants_json = false;
  bool wants_check = false;
  ReportFiles files;
};

std::string all_devices() {
  std::string names;
  for (const auto& entry : hosted_servers()) names += std::string{entry.device} + ", ";
  for (const auto& entry : hosted_devices()) {
    names += std::string{entry.device} + ", ";
  }
  for (const auto& entry : hosted_buses()) names += std::string{entry.device} + ", ";
  names.resize(names.size() - 2);
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

/// Scheduling of client and emulator; more than that is seen only on a machine that has no time.
constexpr Duration kSchedulingNoise = std::chrono::milliseconds{10};

Outcome<std::unique_ptr<ProgramCheck>> make_check(const Options& options) {
  const LinkNoise noise{std::chrono::duration_cast<Duration>(kSchedulingNoise * options.speed)};
  return make_program_check(options.device, noise);
}

template <class Check>
Exit conclude(Check& check, const Options& options) {
  const auto result = check.finish();
  fmt::print("{}\n", options.wants_json ? to_json(result) : to_text(result));
  if (const auto written = write_files(result, options.files); !written) {
    return report(written.error());
  }
  return static_cast<Exit>(conclusion_of(result));
}

/// Until it is stopped. Lines on standard input set `inputs`.
template <class AnyHost>
void run(AnyHost& host, std::span<const DeviceInput> inputs) {
  {
    std::optional<DeviceInputs> by_hand;
    if (!inputs.empty()) {
      by_hand.emplace(inputs, [&host](auto name, auto value, auto tell) {
        host.set_input(std::move(name), value, std::move(tell));
      });
    }
    host.run();
  }
  print_statistics(host.statistics());
}

Exit emulate_server(const ServerEntry& entry, const Options& options,
                    const DeviceOptions& settings) {
  if (options.wants_pty || !options.pty.link.empty()) {
    return report(
        Problem{ErrorCode::kBadValue, options.device,
                "it is a TCP server and has no pseudo-terminal; leave out --pty, --link"});
  }
  const bool takes_inputs = has_standard_input();
  auto server = entry.make(settings, options.device);
  if (!server) return report(server.error());
  std::unique_ptr<ProgramCheck> check;
  if (options.wants_check) {
    auto made = make_check(options);
    if (!made) return report(made.error());
    check = *std::move(made);
    server = check->watch(*std::move(server));
  }
  SessionHostOptions host_options{.tcp = options.tcp, .speed = options.speed};
  if (!options.wants_tcp) host_options.tcp.port = entry.port;
  host_options.on_signal = HostOptions::OnSignal::kStop;
  host_options.log = [](std::string_view line) { fmt::print(stderr, "armjig: {}\n", line); };
  auto host = SessionHost::open(std::move(*server), host_options);
  if (!host) return report(host.error());
  announce(options, {host->target()});
  run(*host, takes_inputs ? entry.inputs() : std::span<const DeviceInput>{});
  return check ? conclude(*check, options) : Exit::kPassed;
}

Exit emulate_bus(const BusEntry& entry, const Options& options, const DeviceOptions& settings) {
  const bool has_others =
      options.wants_pty || !options.pty.link.empty() || options.wants_tcp || options.speed != 1;
  if (has_others) {
    return report({ErrorCode::kBadValue, options.device,
                   "a bus takes --set, --json and --check, and no other option"});
  }
  const auto form = options.wants_json ? Announcement::kJson : Announcement::kText;
  if (!options.wants_check) return emulate_bus(entry, settings, form, {});
  const auto check = BusCheck::make(options.device);
  if (!check) return report(check.error());
  const auto served = emulate_bus(entry, settings, form, (*check)->listener());
  return served == Exit::kPassed ? conclude(**check, options) : served;
}

Exit emulate(const Options& options) {
  const auto settings = parse_settings(options.settings);
  if (!settings) return report(settings.error());
  if (const auto* bus = find_hosted_bus(options.device)) {
    return emulate_bus(*bus, options, *settings);
  }
  for (const auto& entry : hosted_servers()) {
    if (entry.device == options.device) return emulate_server(entry, options, *settings);
  }
  const bool takes_inputs = has_standard_input();
  auto device = make_hosted_device(options.device, *settings);
  if (!device) return report(device.error());
  std::unique_ptr<ProgramCheck> check;
  if (options.wants_check) {
    auto made = make_check(options);
    if (!made) return report(made.error());
    check = *std::move(made);
    device = check->watch(*std::move(device));
  }
  auto host = Host::open(std::move(*device), host_options(options));
  if (!host) return report(host.error());
  announce(options, host->targets());
  run(*host,
      takes_inputs ? hosted_device(options.device).inputs() : std::span<const DeviceInput>{});
  return check ? conclude(*check, options) : Exit::kPassed;
}

void add_check(CLI::App& command, Options& options) {
  auto* check =
      command.add_flag("--check", options.wants_check, "judge the program that talks to it");
  struct Form {
    const char* option;
    std::string* path;
    const char* what;
  };
  for (const auto& [option, path, what] : {Form{"--html", &options.files.html, "a page"},
                                           Form{"--junit", &options.files.junit, "JUnit XML"},
                                           Form{"--sarif", &options.files.sarif, "SARIF"}}) {
    command
        .add_option(option, *path, fmt::format("also write the report to this file as {}", what))
        ->type_name("FILE")
        ->needs(check);
  }
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
  command->add_flag("--json", options->wants_json,
                    "say where it listens as one line of JSON; the report of --check too");
  add_check(*command, *options);
  command->callback([options, tcp, &action] {
    options->wants_tcp = tcp->count() > 0;
    action = [options] { return emulate(*options); };
  });
}

}  // namespace armjig::cli
