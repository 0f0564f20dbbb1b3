// SPDX-License-Identifier: Apache-2.0
#include "cli/serving.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cli/device_inputs.hpp"
#include "cli/program_judge.hpp"
#include "cli/terminal.hpp"
#include "harness/core/number.hpp"
#include "harness/link/descriptor.hpp"

namespace armjig::cli {
namespace {

/// Scheduling of client and emulator; more than that is seen only on a machine that has no time.
constexpr Duration kSchedulingNoise = std::chrono::milliseconds{10};

/// For the only device. Programs find a virtual bus only in its `environment`.
void announce(const Serving& serving, const std::vector<std::string>& targets,
              const std::vector<std::string>& environment, bool wants_json) {
  if (wants_json) {
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
}

void announce_lab(const ServedDevices& devices, bool wants_json) {
  const auto environment = devices.environment();
  if (wants_json) {
    nlohmann::ordered_json line{{"schema", "armjig.lab/1"}};
    for (const auto& one : devices.all()) {
      line["devices"].push_back(
          {{"name", one.serving.name}, {"device", one.serving.device}, {"listening", one.targets}});
    }
    if (!environment.empty()) line["environment"] = environment;
    line["pid"] = ::getpid();
    return fmt::print("{}\n", line.dump());
  }
  for (const auto& one : devices.all()) {
    fmt::print("{} ({}): {}\n", one.serving.name, one.serving.device, fmt::join(one.targets, " "));
  }
  if (environment.empty()) return;
  fmt::print("device nodes are there for programs that are started with\n  {} PROGRAM\n",
             fmt::join(environment, " "));
}

/// `who` is empty or ends with a blank.
void print_statistics(const HostStatistics& statistics, std::string_view who) {
  const auto& links = statistics.links;
  fmt::print(stderr,
             "armjig: {}{} clients served, {} refused; {} bytes in, {} bytes out, {} frames "
             "dropped\n",
             who, links.clients, links.refused, links.bytes_in, links.bytes_out,
             links.frames_dropped);
  if (statistics.lost > Duration::zero()) {
    fmt::print(stderr, "armjig: {}this machine is too slow: {:.3f} s of device time were lost\n",
               who, std::chrono::duration<double>{statistics.lost}.count());
  }
}

constexpr char kSignalled = 's';
constexpr char kGone = 'g';
std::atomic<int> end_of_server{-1};  ///< a pipe
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void on_end_of_server(int /*signal*/) {
  const auto error = errno;
  (void)!::write(end_of_server, &kSignalled, 1);
  errno = error;
}

/// What ends a server: signals, also to threads of libraries, or that its devices have gone by
/// themselves. One at a time.
class EndOfServer {
 public:
  EndOfServer() {
    std::array<int, 2> ends{-1, -1};
    (void)!::pipe2(ends.data(), O_CLOEXEC);
    reading_ = Descriptor{ends[0]};
    writing_ = Descriptor{ends[1]};
    end_of_server = writing_.value();
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      ::sigaction(kSignals[i], nullptr, &before_[i]);
      if (kSignals[i] == SIGHUP && before_[i].sa_handler == SIG_IGN) continue;  // nohup
      struct sigaction action{};
      action.sa_handler = on_end_of_server;
      action.sa_flags = SA_RESTART;
      ::sigaction(kSignals[i], &action, nullptr);
    }
  }
  EndOfServer(const EndOfServer&) = delete;
  EndOfServer& operator=(const EndOfServer&) = delete;
  ~EndOfServer() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      ::sigaction(kSignals[i], &before_[i], nullptr);
    }
  }

  /// From any thread: one has gone.
  void note_gone() const noexcept { (void)!::write(writing_.value(), &kGone, 1); }

  /// Waits for a signal, or until so many have gone.
  void wait(std::size_t count) const {
    char what{};
    for (std::size_t gone = 0; gone < count;) {
      // GCC 12's ThreadSanitizer keeps signals back from a thread in read(), but not in poll().
      pollfd ready{.fd = reading_.value(), .events = POLLIN, .revents = 0};
      if (::poll(&ready, 1, -1) < 0 && errno == EINTR) continue;
      const auto size = ::read(reading_.value(), &what, 1);
      if (size < 0 && errno == EINTR) continue;
      if (size <= 0 || what == kSignalled) return;
      ++gone;
    }
  }

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};

  std::array<struct sigaction, kSignals.size()> before_{};
  Descriptor reading_;
  Descriptor writing_;
};

/// The inputs of devices, by the names that people write.
class InputsByName {
 public:
  InputsByName(const ServedDevices& devices, bool has_prefixes) : has_prefixes_{has_prefixes} {
    for (const auto& one : devices.all()) {
      auto& host = hosts_[has_prefixes ? one.serving.name : ""] = &one.served->host();
      for (const auto& input : host->inputs()) {
        names_.push_back(has_prefixes ? fmt::format("{}.{}", one.serving.name, input.name)
                                      : std::string{input.name});
        values_.push_back(input.values);
      }
    }
    for (std::size_t i = 0; i < names_.size(); ++i) inputs_.push_back({names_[i], values_[i]});
  }

  [[nodiscard]] std::span<const DeviceInput> all() const noexcept { return inputs_; }

  void set(const std::string& name, std::int64_t value,
           std::function<void(bool is_taken)> tell) const {
    const auto dot = has_prefixes_ ? name.find('.') : std::string::npos;
    const auto host = hosts_.find(dot == std::string::npos ? "" : name.substr(0, dot));
    if (host == hosts_.end()) return tell(false);
    host->second->set_input(has_prefixes_ ? name.substr(dot + 1) : name, value, std::move(tell));
  }

 private:
  bool has_prefixes_;
  std::map<std::string, Host*> hosts_;
  std::vector<std::string> names_;
  std::vector<std::string_view> values_;
  std::vector<DeviceInput> inputs_;
};

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

/// What an emulated device is called on USB: by the numbers of its entry or, if it has none, by
/// those that pid.codes keeps for trials.
usb::Identity usb_identity(const Device& device) {
  constexpr UsbId kForTrials{0x1209, 0x0001};
  const auto* const stream = std::get_if<OnStream>(&device.port);
  const auto id = stream == nullptr ? kForTrials : stream->usb.value_or(kForTrials);
  return {.vendor = id.vendor,
          .product = id.product,
          .manufacturer = "armjig",
          .product_name = std::string{device.title},
          .serial_number = {}};
}

Outcome<ServedDevices::One> open_one(AnyHosted hosted, const Serving& serving,
                                     const std::function<void()>& when_over, DeviceNodes& nodes) {
  auto host = Host::open(std::move(hosted), serving.how);
  if (!host) return tl::unexpected{host.error()};
  ServedDevices::One one{serving, serve_aside(*std::move(host), when_over), {}};
  one.targets = one.served->targets();
  const auto add = [&](std::string_view scheme, const Outcome<std::string>& node) {
    return node.map([&](const std::string& path) {
      one.targets.insert(one.targets.begin(), fmt::format("{}:{}", scheme, path));
    });
  };
  Outcome<void> added;
  if (serving.bus) added = add("i2c", nodes.add_bus(*serving.bus, one.served->host()));
  if (serving.board) {
    constexpr std::string_view kTerminal{"pty:"};
    const auto terminal = one.targets.front().substr(kTerminal.size());
    added = add("serial", nodes.add_board(*serving.board, serving.identity, terminal));
  }
  if (!added) return tl::unexpected{std::move(added.error())};
  return one;
}

}  // namespace

bool is_usb_text(std::string_view text) noexcept {
  return text.size() <= usb::kLongestText &&
         std::ranges::all_of(text, [](char c) { return c > ' ' && c <= '~'; });
}

std::function<void(std::string_view line)> log_as(std::string_view name) {
  return [who = name.empty() ? std::string{} : fmt::format("{}: ", name)](std::string_view line) {
    fmt::print(stderr, "armjig: {}{}\n", who, line);
  };
}

Serving serving_at(const Device& device, std::string name, const Places& places, double speed) {
  auto identity = usb_identity(device);
  identity.serial_number =
      places.usb_serial.empty() ? fmt::format("{}-emulated", name) : places.usb_serial;
  HostOptions how{.pty = places.pty, .speed = speed, .log = log_as({})};
  const auto tcp = [&places](std::uint16_t port, TcpOptions::Protocol protocol) {
    TcpOptions options{.port = port, .protocol = protocol};
    if (!places.bind.empty()) options.address = places.bind;
    return options;
  };
  if (places.tcp) how.tcp = tcp(*places.tcp, TcpOptions::Protocol::kPlain);
  if (places.rfc2217) how.rfc2217 = tcp(*places.rfc2217, TcpOptions::Protocol::kRfc2217);
  if (!places.usb_socket.empty()) {
    how.usb.push_back({identity, UsbredirSocket{places.usb_socket}});
  }
  if (places.usbip) how.usb.push_back({identity, UsbipPort{*places.usbip}});
  if (places.board && !how.pty) how.pty.emplace();
  return {.name = std::move(name),
          .device = std::string{device.name},
          .how = std::move(how),
          .board = places.board,
          .bus = places.bus,
          .identity = std::move(identity)};
}

Outcome<Serving> parse_listen(const std::string& listen, const Device& device) {
  auto serving = serving_at(device, std::string{device.name}, {});
  const auto hint =
      std::visit([&](const auto& kind) { return take_place(kind, listen, serving); }, device.port);
  if (!hint.empty()) return bad_place(listen, hint);
  return serving;
}

Outcome<std::unique_ptr<ServedDevices>> ServedDevices::open(
    std::vector<ToServe> devices, const std::function<void()>& when_over) {
  auto opened = std::make_unique<ServedDevices>();
  const bool is_only = devices.size() == 1;
  for (auto& [hosted, serving] : devices) {
    auto one = open_one(std::move(hosted), serving, when_over, opened->nodes_);
    if (!one) {
      auto& where = one.error().where;
      if (!is_only) where = fmt::format("{}: {}", serving.name, where);
      return tl::unexpected{std::move(one.error())};
    }
    opened->all_.push_back(*std::move(one));
  }
  return opened;
}

Outcome<void> serve(std::vector<ToServe> devices, const ServerManner& manner) {
  const bool takes_inputs = has_standard_input();
  const bool is_lab = manner.announcement == ServerManner::Announcement::kLab;
  const EndOfServer end;
  const auto opened = ServedDevices::open(std::move(devices), [&end] { end.note_gone(); });
  if (!opened) return tl::unexpected{opened.error()};
  const auto& all = (*opened)->all();
  if (is_lab) {
    announce_lab(**opened, manner.wants_json);
  } else {
    announce(all.front().serving, all.front().targets, (*opened)->environment(), manner.wants_json);
  }
  std::fflush(stdout);  // who waits for the line may read it from a pipe
  {
    const InputsByName inputs{**opened, is_lab};
    std::optional<DeviceInputs> by_hand;
    if (takes_inputs && !inputs.all().empty()) {
      by_hand.emplace(inputs.all(), [&inputs](const auto& name, auto value, auto tell) {
        inputs.set(name, value, std::move(tell));
      });
    }
    end.wait(all.size());
  }
  for (const auto& one : all) {
    one.served->end();
    const auto who = is_lab ? fmt::format("{}: ", one.serving.name) : "";
    if (!manner.is_quiet && !one.serving.bus) {
      print_statistics(one.served->host().statistics(), who);
    }
  }
  return {};
}

LinkNoise link_noise_of(const Device& device, double speed) {
  // A program waits for each transaction of a bus, so no pause is seen shorter than it was.
  if (std::holds_alternative<OnBus>(device.port)) return {};
  return {std::chrono::duration_cast<Duration>(kSchedulingNoise * speed)};
}

Outcome<std::unique_ptr<ProgramCheck>> check_if(bool is_wanted, const Device& device, double speed,
                                                std::string_view name) {
  if (!is_wanted) return nullptr;
  return make_program_check(device, link_noise_of(device, speed), name);
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
