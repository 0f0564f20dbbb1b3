// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/capture_options.hpp"
#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/device_inputs.hpp"
#include "cli/program_judge.hpp"
#include "cli/report_files.hpp"
#include "cli/terminal.hpp"
#include "emulators/host/host.hpp"
#include "emulators/lab/virtual_i2c.hpp"

namespace armjig::cli {
namespace {

constexpr auto kHelp =
    "An emulated device for programs that expect a real one, in real time.\n"
    "\n"
    "  armjig emulate DEVICE                        where a device of its kind is: on a new\n"
    "                                               pseudo-terminal, its TCP port, an I2C bus\n"
    "  armjig emulate DEVICE --link /tmp/arm        the same, under a name that stays\n"
    "  armjig emulate DEVICE --tcp 4000             as a byte stream on TCP, this machine only\n"
    "  armjig emulate DEVICE --tcp 0 --pty --json   both, any free port, for scripts\n"
    "  armjig emulate DEVICE --set fault=NAME       a faulty one; 'conformance mutants' has names\n"
    "  armjig emulate DEVICE --check                tells what the client program does wrong\n"
    "  armjig emulate DEVICE --capture x.pcapng     records what passes, for Wireshark\n"
    "\n"
    "Lines on standard input do to the device what no client can, such as 'estop 0'; 'help' lists\n"
    "them.\n"
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
  int bus = 1;
  double speed = 1;
  bool wants_json = false;
  bool wants_check = false;
  CaptureOptions capture;
  ReportFiles files;
  std::string colour;
};

HostOptions host_options(const Options& options) {
  HostOptions host;
  if (options.wants_pty || !options.pty.link.empty() || !options.wants_tcp) host.pty = options.pty;
  if (options.wants_tcp) host.tcp = options.tcp;
  host.speed = options.speed;
  host.on_signal = HostOptions::OnSignal::kStop;
  host.log = [](std::string_view line) { fmt::print(stderr, "armjig: {}\n", line); };
  return host;
}

/// Programs find a virtual bus only in its `environment`.
void announce(const Options& options, const std::vector<std::string>& targets,
              const std::vector<std::string>& environment = {}) {
  if (options.wants_json) {
    nlohmann::ordered_json line{
        {"schema", "armjig.emulate/1"}, {"device", options.device}, {"listening", targets}};
    if (!environment.empty()) line["environment"] = environment;
    line["pid"] = ::getpid();
    fmt::print("{}\n", line.dump());
  } else if (!environment.empty()) {
    fmt::print("listening {} for programs that are started with\n  {} PROGRAM\n", targets.front(),
               fmt::join(environment, " "));
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
    auto name = setting.substr(0, equals);
    if (options.contains(name)) {
      return problem(ErrorCode::kBadValue, "--set " + setting, "it is said twice");
    }
    options[std::move(name)] = setting.substr(equals + 1);
  }
  return options;
}

/// As `--target` would have them.
std::string target_of(const DeviceOptions& settings) {
  std::string text{"emulated:"};
  for (const auto& [name, value] : settings) {
    text += fmt::format("{}{}={}", text.ends_with(':') ? '?' : '&', name, value);
  }
  return text;
}

/// Scheduling of client and emulator; more than that is seen only on a machine that has no time.
constexpr Duration kSchedulingNoise = std::chrono::milliseconds{10};

Exit conclude(ProgramCheck& check, const Options& options, const ReportOutputs& files) {
  const auto result = check.finish();
  fmt::print("{}\n", options.wants_json ? to_json(result)
                                        : to_text(result, style_of(options.colour, stdout)));
  files.put(result);
  return static_cast<Exit>(conclusion_of(result));
}

/// Until it is stopped. Lines on standard input do what can be done beside the device.
Outcome<void> host(AnyHosted hosted, const HostOptions& how, const Options& options) {
  const bool takes_inputs = has_standard_input();
  const auto inputs = std::visit([](const auto& device) { return device->inputs(); }, hosted);
  auto host = Host::open(std::move(hosted), how);
  if (!host) return tl::unexpected{host.error()};
  announce(options, host->targets());
  {
    std::optional<DeviceInputs> by_hand;
    if (takes_inputs && !inputs.empty()) {
      by_hand.emplace(inputs, [&host](auto name, auto value, auto tell) {
        host->set_input(std::move(name), value, std::move(tell));
      });
    }
    host->run();
  }
  print_statistics(host->statistics());
  return {};
}

Outcome<void> serve(std::unique_ptr<HostedStream> hosted, const OnStream& /*kind*/,
                    const Options& options) {
  return host(std::move(hosted), host_options(options), options);
}

Outcome<void> serve(std::unique_ptr<HostedServer> hosted, const OnServer& kind,
                    const Options& options) {
  if (options.wants_pty || !options.pty.link.empty()) {
    return problem(ErrorCode::kUnsupported, options.device,
                   "it is a TCP server and has no pseudo-terminal; leave out --pty, --link");
  }
  auto how = host_options(options);
  how.pty.reset();
  how.tcp = options.tcp;
  if (!options.wants_tcp) how.tcp->port = kind.tcp_port;
  return host(std::move(hosted), how, options);
}

/// Blocks the signals that end a server, for this thread and those that it starts.
sigset_t block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

Outcome<void> serve(std::unique_ptr<HostedBus> hosted, const OnBus& /*kind*/,
                    const Options& options) {
  if (options.wants_pty || !options.pty.link.empty() || options.wants_tcp || options.speed != 1) {
    return problem(ErrorCode::kUnsupported, options.device,
                   "a bus takes --set, --bus, --json and --check, and no other option");
  }
  const auto signals = block_signals();
  const auto i2c = VirtualI2c::open(std::move(hosted), options.bus);
  if (!i2c) return tl::unexpected{i2c.error()};
  announce(options, {"i2c:" + i2c->path()}, i2c->environment());
  int signal = 0;
  ::sigwait(&signals, &signal);
  return {};
}

Exit emulate(Devices devices, const Options& options) {
  const auto settings = parse_settings(options.settings);
  if (!settings) return report(settings.error());
  const auto found = find_device(devices, options.device);
  if (!found) return report(found.error());
  const auto& device = **found;
  std::unique_ptr<ProgramCheck> check;
  if (options.wants_check) {
    // A program waits for each transaction of a bus, so no pause is seen shorter than it was.
    const auto noise = std::holds_alternative<OnBus>(device.port)
                           ? Duration::zero()
                           : std::chrono::duration_cast<Duration>(kSchedulingNoise * options.speed);
    auto made = make_program_check(device, {noise});
    if (!made) return report(made.error());
    check = *std::move(made);
  }
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
        if (check) hosted = check->watch(std::move(hosted));
        return serve(std::move(hosted), kind, options);
      },
      device.port);
  if (!served) return report(served.error());
  return check ? conclude(*check, options, *files) : Exit::kPassed;
}

void add_check(CLI::App& command, Options& options) {
  auto* check =
      command.add_flag("--check", options.wants_check, "judge the program that talks to it");
  // --json says how to announce, and is the report's form then.
  for (auto* file : add_report_files(command, options.files, "json")) file->needs(check);
  add_colour_option(command, options.colour);
}

}  // namespace

void add_emulate(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("emulate", with_example(kHelp, devices));
  const auto options = std::make_shared<Options>();
  add_device_argument(*command, options->device, devices);
  command->add_flag("--pty", options->wants_pty, "on a pseudo-terminal (the default)");
  command
      ->add_option("--link", options->pty.link,
                   "a name that stays for the pseudo-terminal; removed at the end")
      ->type_name("PATH");
  auto* tcp = command->add_option("--tcp", options->tcp.port, "on this TCP port; 0: any free one")
                  ->type_name("PORT")
                  ->transform(whole(0, 65535));
  command->add_option("--bind", options->tcp.address, "address for --tcp (default: 127.0.0.1)")
      ->type_name("ADDRESS")
      ->needs(tcp);
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
  add_check(*command, *options);
  command->callback([options, tcp, devices, &action] {
    options->wants_tcp = tcp->count() > 0;
    action = [options, devices] { return emulate(devices, *options); };
  });
}

}  // namespace armjig::cli
