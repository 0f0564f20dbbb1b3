// SPDX-License-Identifier: Apache-2.0
// What the tap costs: round trips through `armjig record`, which writes all of it to a file, beside
// those through a relay of another process that does nothing but poll, read and write, in
// alternated rounds, over pseudo-terminals and over TCP. And what two rounds of the relay differ
// by. Ratios are medians of the rounds'.
#include <fcntl.h>
#include <fmt/core.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "harness/link/descriptor.hpp"
#include "tests/integration/support/bare_trips.hpp"
#include "tests/integration/support/program.hpp"
#include "tests/integration/support/sockets.hpp"

namespace armjig::testing {
namespace {

constexpr int kRounds = 11;
constexpr std::size_t kTrips = 3'000;
constexpr double kBar = 1.3;
constexpr std::array<std::byte, 56> kRequest{};  // as long as a frame of a PAROL6 board

/// Both ends of a link, the near one as others open it.
struct Place {
  Descriptor far;
  std::string near;  ///< as a target
};

void make_raw(int file) {
  termios settings{};
  (void)::tcgetattr(file, &settings);
  ::cfmakeraw(&settings);
  (void)::tcsetattr(file, TCSANOW, &settings);
}

Descriptor open_terminal(const std::string& path) {
  Descriptor file{::open(path.c_str(), O_RDWR | O_NOCTTY)};
  make_raw(file.value());
  return file;
}

Descriptor connect(const std::string& place) {
  const auto port = std::stoi(place.substr(place.rfind(':') + 1));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  Descriptor socket{::socket(AF_INET, SOCK_STREAM, 0)};
  if (::connect(socket.value(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    fmt::print("nobody listens at {}\n", place);
  }
  const int on = 1;
  (void)::setsockopt(socket.value(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return socket;
}

/// `pty:PATH` or `tcp:HOST:PORT`.
Descriptor open_place(const std::string& target) {
  return target.starts_with("pty:") ? open_terminal(target.substr(4)) : connect(target);
}

/// Both ways, until one of them ends.
void relay(int one, int other) {
  std::array<std::byte, 4096> buffer;
  for (;;) {
    std::array<pollfd, 2> entries{{{.fd = one, .events = POLLIN, .revents = 0},
                                   {.fd = other, .events = POLLIN, .revents = 0}}};
    (void)::poll(entries.data(), entries.size(), -1);
    for (const auto& [from, to] : {std::pair{0, 1}, std::pair{1, 0}}) {
      const auto& source = entries[static_cast<std::size_t>(from)];
      if (source.revents == 0) continue;
      const auto size = ::read(source.fd, buffer.data(), buffer.size());
      if (size <= 0) return;
      (void)!::write(entries[static_cast<std::size_t>(to)].fd, buffer.data(),
                     static_cast<std::size_t>(size));
    }
  }
}

/// A pseudo-terminal; its other end stays open, so that it lives between two clients.
struct Terminal {
  Terminal() {
    int far_end = -1;
    int near_end = -1;
    std::array<char, 64> name{};
    if (::openpty(&far_end, &near_end, name.data(), nullptr, nullptr) != 0) std::abort();
    far = Descriptor{far_end};
    near = Descriptor{near_end};
    make_raw(near.value());
    path = name.data();
  }
  Descriptor far;
  Descriptor near;
  std::string path;
};

/// A relay in a process of its own, which ends with this one.
class Relay {
 public:
  template <class Open>
  explicit Relay(Open open) : pid_{::fork()} {
    if (pid_ != 0) return;
    const auto [one, other] = open();
    relay(one, other);
    ::_exit(0);
  }
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;
  ~Relay() { (void)::kill(pid_, SIGKILL); }

 private:
  pid_t pid_;
};

/// The program between that target and the place that it says.
struct Tap {
  Tap(const std::string& listen, const std::string& target)
      : program{{"record", "demo", "--listen", listen, "--target", target, "--out", file,
                 "--json"}},
        place{nlohmann::json::parse(program.read_line())["listening"][0]} {}
  ~Tap() {
    program.signal(SIGINT);
    (void)program.wait();
    std::filesystem::remove(file);
  }
  Tap(const Tap&) = delete;
  Tap& operator=(const Tap&) = delete;

  std::string file =
      std::filesystem::temp_directory_path() / fmt::format("armjig-tap-{}.pcapng", ::getpid());
  Program program;
  std::string place;
};

bool compare(std::string_view name, int through_tap, int through_relay) {
  std::array<std::vector<double>, 4> ratios;
  for (int i = 0; i < kRounds; ++i) {
    const auto first = bare_trips(through_relay, kRequest, kTrips);
    const auto tapped = bare_trips(through_tap, kRequest, kTrips);
    const auto second = bare_trips(through_relay, kRequest, kTrips);
    ratios[0].push_back(tapped.median / first.median);
    ratios[1].push_back(tapped.p99 / first.p99);
    ratios[2].push_back(second.median / first.median);
    ratios[3].push_back(second.p99 / first.p99);
  }
  fmt::print("{}: tap to relay {:.2f} at 50 %, {:.2f} at 99 %; relay to relay {:.2f}, {:.2f}\n",
             name, middle(ratios[0]), middle(ratios[1]), middle(ratios[2]), middle(ratios[3]));
  return middle(ratios[0]) <= kBar && middle(ratios[1]) <= kBar;
}

bool compare_terminals() {
  const Terminal tapped;
  const Terminal relayed;
  const Terminal front;
  const Relay relay{[&] { return std::pair{front.far.value(), relayed.near.value()}; }};
  std::thread{echo, tapped.far.value()}.detach();
  std::thread{echo, relayed.far.value()}.detach();
  const Tap tap{"pty:", "pty:" + tapped.path};
  const auto client = open_place(tap.place);
  return compare("PTY", client.value(), front.near.value());
}

/// Serves one connection.
void serve(const Listener& listener) {
  std::thread{[&listener] {
    const auto socket = listener.accept();
    const int on = 1;
    (void)::setsockopt(socket.value(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    echo(socket.value());
  }}.detach();
}

bool compare_tcp() {
  static const Listener tapped;
  static const Listener relayed;
  static const Listener front;
  const Relay relay{[&] {
    const auto target = connect("tcp:" + relayed.address());
    const auto client = front.accept();
    const int on = 1;
    (void)::setsockopt(client.value(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return std::pair{::dup(client.value()), ::dup(target.value())};
  }};
  serve(tapped);
  serve(relayed);
  const Tap tap{"tcp:0", "tcp:" + tapped.address()};
  const auto through_tap = open_place(tap.place);
  const auto through_relay = connect("tcp:" + front.address());
  return compare("TCP", through_tap.value(), through_relay.value());
}

}  // namespace
}  // namespace armjig::testing

int main() {
  const bool is_terminal_met = armjig::testing::compare_terminals();
  const bool is_tcp_met = armjig::testing::compare_tcp();
  return is_terminal_met && is_tcp_met ? 0 : 1;
}
