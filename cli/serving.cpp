// SPDX-License-Identifier: Apache-2.0
#include "cli/serving.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cli/device_inputs.hpp"
#include "cli/program_judge.hpp"
#include "cli/terminal.hpp"
#include "emulators/lab/virtual_i2c.hpp"
#include "harness/core/number.hpp"

namespace armjig::cli {
namespace {

/// Scheduling of client and emulator; more than that is seen only on a machine that has no time.
constexpr Duration kSchedulingNoise = std::chrono::milliseconds{10};

/// Programs find a virtual bus only in its `environment`.
void announce(const Serving& serving, const std::vector<std::string>& targets,
              const std::vector<std::string>& environment = {}) {
  if (serving.wants_json) {
    nlohmann::ordered_json line{
        {"schema", "armjig.emulate/1"}, {"device", serving.device}, {"listening", targets}};
    if (!environment.empty()) line["environment"] = environment;
    line["pid"] = ::getpid();
    fmt::print("{}\n", line.dump());
  } else if (!environment.empty()) {
    fmt::print("listening {} for programs that are started with\n  {} PROGRAM\n", targets.front(),
               fmt::join(environment, " "));
  } else {
    const bool has_link = serving.how.pty && !serving.how.pty->link.empty();
    const auto link = has_link ? std::size_t{1} : targets.size();
    for (std::size_t i = 0; i < targets.size(); ++i) {
      fmt::print("listening {}{}\n", targets[i], i == link ? " (link)" : "");
    }
  }
  std::fflush(stdout);  // who waits for the line may read it from a pipe
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

/// Blocks the signals that end a server, for this thread and those that it starts.
sigset_t block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

Outcome<void> serve_bus(std::unique_ptr<HostedBus> hosted, const Serving& serving) {
  const auto signals = block_signals();
  const auto i2c = VirtualI2c::open(std::move(hosted), serving.bus);
  if (!i2c) return tl::unexpected{i2c.error()};
  announce(serving, {"i2c:" + i2c->path()}, i2c->environment());
  int signal = 0;
  ::sigwait(&signals, &signal);
  return {};
}

tl::unexpected<Problem> bad_place(const std::string& listen, std::string_view hint) {
  return problem(ErrorCode::kBadValue, "--listen " + listen, std::string{hint});
}

/// `[HOST:]PORT`
std::optional<TcpOptions> parse_tcp_place(std::string_view text) {
  TcpOptions tcp;
  const auto colon = text.rfind(':');
  if (colon != std::string_view::npos) {
    tcp.address = text.substr(0, colon);
    if (tcp.address.starts_with('[') && tcp.address.ends_with(']')) {
      tcp.address = tcp.address.substr(1, tcp.address.size() - 2);
    }
    text.remove_prefix(colon + 1);
  }
  const auto port = whole_text_as<std::uint16_t>(text);
  if (!port || tcp.address.empty()) return std::nullopt;
  tcp.port = *port;
  return tcp;
}

/// Shortens `place` by `scheme` if it starts with it.
bool takes(std::string_view& place, std::string_view scheme) {
  if (!place.starts_with(scheme)) return false;
  place.remove_prefix(scheme.size());
  return true;
}

// What a place says depends on the kind of port. Each returns a hint if the place is not for it.

std::string_view take_place(const OnBus& /*kind*/, std::string_view place, Serving& serving) {
  constexpr int kLastBus = 255;
  if (!takes(place, "i2c:")) return "this device is on a bus: write i2c:N";
  (void)takes(place, "/dev/i2c-");
  const auto number = whole_text_as<int>(place);
  if (!number || *number < 0 || *number > kLastBus) return "write i2c:N, 0 to 255";
  serving.bus = *number;
  return {};
}

std::string_view take_place(const OnServer& /*kind*/, std::string_view place, Serving& serving) {
  if (takes(place, "tcp:")) serving.how.tcp = parse_tcp_place(place);
  if (serving.how.tcp) return {};
  return "it is a TCP server and has no pseudo-terminal or serial port: write tcp:PORT or "
         "tcp:HOST:PORT";
}

std::string_view take_place(const OnStream& /*kind*/, std::string_view place, Serving& serving) {
  if (takes(place, "pty:")) {
    serving.how.pty = PtyOptions{std::string{place}};
  } else if (takes(place, "tcp:")) {
    serving.how.tcp = parse_tcp_place(place);
  } else if (takes(place, "rfc2217:")) {
    serving.how.rfc2217 = parse_tcp_place(place);
    if (serving.how.rfc2217) serving.how.rfc2217->protocol = TcpOptions::Protocol::kRfc2217;
  }
  if (serving.how.pty || serving.how.tcp || serving.how.rfc2217) return {};
  return "write pty:, pty:PATH, tcp:PORT, tcp:HOST:PORT, rfc2217:PORT or rfc2217:HOST:PORT";
}

}  // namespace

HostOptions server_options() {
  HostOptions host;
  host.on_signal = HostOptions::OnSignal::kStop;
  host.log = [](std::string_view line) { fmt::print(stderr, "armjig: {}\n", line); };
  return host;
}

usb::Identity usb_identity(const Device& device, std::optional<UsbId> numbers) {
  constexpr UsbId kForTrials{0x1209, 0x0001};
  const auto id = numbers.value_or(kForTrials);
  return {.vendor = id.vendor,
          .product = id.product,
          .manufacturer = "armjig",
          .product_name = std::string{device.title},
          .serial_number = fmt::format("{}-emulated", device.name)};
}

Outcome<Serving> parse_listen(const std::string& listen, const Device& device) {
  Serving serving{.device = std::string{device.name}, .how = server_options()};
  const auto hint =
      std::visit([&](const auto& kind) { return take_place(kind, listen, serving); }, device.port);
  if (!hint.empty()) return bad_place(listen, hint);
  return serving;
}

Outcome<void> serve(AnyHosted hosted, const Serving& serving) {
  auto* const bus = std::get_if<std::unique_ptr<HostedBus>>(&hosted);
  if (bus != nullptr && serving.how.usb.empty()) {
    return serve_bus(std::move(*bus), serving);
  }
  const bool takes_inputs = has_standard_input();
  auto host = Host::open(std::move(hosted), serving.how);
  if (!host) return tl::unexpected{host.error()};
  const auto inputs = host->inputs();
  announce(serving, host->targets());
  {
    std::optional<DeviceInputs> by_hand;
    if (takes_inputs && !inputs.empty()) {
      by_hand.emplace(inputs, [&host](auto name, auto value, auto tell) {
        host->set_input(std::move(name), value, std::move(tell));
      });
    }
    host->run();
  }
  if (!serving.is_quiet) print_statistics(host->statistics());
  return {};
}

LinkNoise link_noise_of(const Device& device, double speed) {
  // A program waits for each transaction of a bus, so no pause is seen shorter than it was.
  if (std::holds_alternative<OnBus>(device.port)) return {};
  return {std::chrono::duration_cast<Duration>(kSchedulingNoise * speed)};
}

Outcome<std::unique_ptr<ProgramCheck>> check_if(bool is_wanted, const Device& device,
                                                double speed) {
  if (!is_wanted) return nullptr;
  return make_program_check(device, link_noise_of(device, speed));
}

void add_program_check(CLI::App& command, bool& is_wanted, ReportFiles& files,
                       std::string& colour) {
  auto* check = command.add_flag("--check", is_wanted, "judge the program that talks to it");
  // --json says how to announce, and is the report's form then.
  for (auto* file : add_report_files(command, files, "json")) file->needs(check);
  add_colour_option(command, colour);
}

Exit conclude(ProgramCheck& check, bool wants_json, const std::string& colour,
              const ReportOutputs& files) {
  const auto result = check.finish();
  fmt::print("{}\n", wants_json ? to_json(result) : to_text(result, style_of(colour, stdout)));
  files.put(result);
  return static_cast<Exit>(conclusion_of(result));
}

}  // namespace armjig::cli
