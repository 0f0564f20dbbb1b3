// SPDX-License-Identifier: Apache-2.0
// What hosting costs: 300 emulated PAROL6 boards on pseudo-terminals in one process, each asked 100
// times a second, beside 300 bare echoes that one epoll loop serves, in alternated rounds: the
// share of replies that took longer than 1 ms, each of which is reported, and processor time. And a
// KinovaZED command beside an echo of the same length over TCP. Ratios are medians of the rounds'.
//
//   boards_soak [ROUNDS [SECONDS]]
#include <fmt/core.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <ctime>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/host/host.hpp"
#include "emulators/kinovazed/server.hpp"
#include "emulators/memory/hosted.hpp"
#include "emulators/parol6/options.hpp"
#include "harness/timing/latency_histogram.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "tests/integration/support/bare_trips.hpp"
#include "tests/unit/support/link_ends.hpp"

namespace armjig::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kBoards = 300;
constexpr auto kPeriod = 10ms;
constexpr auto kLate = 1ms;
constexpr double kMostLate = 2;  ///< times the share of the echoes
constexpr double kMostTime = 3;  ///< times their processor time
constexpr double kMostP99 = 1.5;
constexpr std::size_t kTrips = 5'000;  ///< of a command
constexpr std::string_view kCommand = "EStop\r\n";
constexpr std::string_view kAccepted = "Accepted\r\n";

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span{text});
}

/// Answers each whole request on each file, until the process is killed.
void serve(const std::vector<int>& files, std::size_t request_size, Bytes reply) {
  const Descriptor epoll{::epoll_create1(0)};
  for (std::size_t i = 0; i < files.size(); ++i) {
    epoll_event event{.events = EPOLLIN, .data = {.u64 = i}};
    (void)::epoll_ctl(epoll.value(), EPOLL_CTL_ADD, files[i], &event);
  }
  std::vector<std::size_t> came(files.size());
  std::array<epoll_event, 64> events;
  std::array<std::byte, 4096> buffer;
  for (;;) {
    const int count = ::epoll_wait(epoll.value(), events.data(), int{events.size()}, -1);
    for (const auto& event :
         std::span{events}.first(static_cast<std::size_t>(std::max(count, 0)))) {
      const auto size = ::read(files[event.data.u64], buffer.data(), buffer.size());
      auto& here = came[event.data.u64];
      here += static_cast<std::size_t>(std::max<ssize_t>(size, 0));
      for (; here >= request_size; here -= request_size) {
        (void)!::write(files[event.data.u64], reply.data(), reply.size());
      }
    }
  }
}

/// A process of its own, which says where it can be found, and ends with this one.
class Served {
 public:
  /// `serve` calls what it is given with its places, separated by spaces, and does not come back.
  using Tell = std::function<void(const std::string& places)>;
  explicit Served(const std::function<void(const Tell& tell)>& serve) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) std::abort();
    pid_ = ::fork();
    const Descriptor reading{pipe[0]};
    const Descriptor writing{pipe[1]};
    if (pid_ == 0) {
      (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
      serve([&](const std::string& places) {
        const auto line = places + '\n';
        (void)!::write(writing.value(), line.data(), line.size());
      });
      ::_exit(1);
    }
    std::string word;
    for (char byte{}; ::read(reading.value(), &byte, 1) == 1;) {
      if (byte != ' ' && byte != '\n') {
        word += byte;
        continue;
      }
      places_.push_back(std::exchange(word, {}));
      if (byte == '\n') break;
    }
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;
  ~Served() {
    (void)::kill(pid_, SIGKILL);
    (void)::waitpid(pid_, nullptr, 0);
  }

  [[nodiscard]] const std::vector<std::string>& places() const noexcept { return places_; }
  [[nodiscard]] Duration processor_time() const {
    clockid_t clock{};
    timespec time{};
    (void)::clock_getcpuclockid(pid_, &clock);
    (void)::clock_gettime(clock, &time);
    return std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec};
  }

 private:
  pid_t pid_ = -1;
  std::vector<std::string> places_;
};

void serve_boards(const Served::Tell& tell) {
  const auto thread = make_host_thread();
  std::vector<Host> hosts;
  std::string places;
  for (std::size_t i = 0; i < kBoards; ++i) {
    auto board = parol6::emulation::make({}, "board").value();
    hosts.push_back(
        Host::open(make_hosted(std::move(board)), {.pty = PtyOptions{}, .thread = thread}).value());
    places += (i == 0 ? "" : " ") + hosts.back().targets().front().substr(4);
  }
  tell(places);
  hosts.front().run();
}

void serve_echoes(const Served::Tell& tell) {
  std::vector<test::LinkEnds> ends;
  std::vector<int> files;
  std::string places;
  for (std::size_t i = 0; i < kBoards; ++i) {
    ends.push_back(test::make_terminal_ends());
    files.push_back(ends.back().far.value());
    places += (i == 0 ? "" : " ") + std::string{::ttyname(ends.back().near.value())};
  }
  tell(places);
  serve(files, parol6::kCommandFrameSize, std::array<std::byte, parol6::kTelemetryFrameSize>{});
}

struct Late {
  std::size_t board;
  Duration at;
  Duration took;
};

struct Round {
  std::uint64_t asked = 0;
  std::uint64_t answered = 0;
  std::vector<Late> late;
  LatencyHistogram took;
  Duration processor_time{};

  /// Of those that were asked; what did not come at all is late, too.
  [[nodiscard]] double share_late() const {
    const auto lost = asked - answered;
    return static_cast<double>(late.size() + lost) / static_cast<double>(asked);
  }
};

/// Asks each of them in its turn, and listens to all of them.
class Client {
 public:
  explicit Client(const std::vector<std::string>& places) : epoll_{::epoll_create1(0)} {
    for (const auto& place : places) {
      Descriptor file{::open(place.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)};
      termios settings{};
      (void)::tcgetattr(file.value(), &settings);
      ::cfmakeraw(&settings);
      (void)::tcsetattr(file.value(), TCSANOW, &settings);
      epoll_event event{.events = EPOLLIN, .data = {.u64 = lines_.size()}};
      (void)::epoll_ctl(epoll_.value(), EPOLL_CTL_ADD, file.value(), &event);
      lines_.push_back({.file = std::move(file)});
    }
  }

  /// For that long, and then until all answers are there, or a second has passed.
  Round run(Bytes request, Duration time) {
    round_ = {};
    start_ = Clock::now();
    const auto step = kPeriod / static_cast<double>(lines_.size());
    const auto count = static_cast<std::uint64_t>(time / step);
    for (std::uint64_t i = 0; i < count; ++i) {
      listen_until(start_ + std::chrono::duration_cast<Duration>(step * static_cast<double>(i)));
      auto& line = lines_[i % lines_.size()];
      line.asked.push_back(Clock::now());
      (void)!::write(line.file.value(), request.data(), request.size());
    }
    round_.asked = count;
    const auto patience = Clock::now() + 1s;
    while (round_.answered < count && Clock::now() < patience) listen_until(Clock::now() + 1ms);
    return std::move(round_);
  }

 private:
  struct Line {
    Descriptor file;
    std::size_t came = 0;  ///< of the next answer
    std::deque<Clock::time_point> asked{};
  };

  void listen_until(Clock::time_point time) {
    std::array<epoll_event, 64> events;
    do {
      const auto left = std::max<Clock::duration>(time - Clock::now(), 0ns);
      const timespec wait{.tv_sec = 0, .tv_nsec = std::min<long>(left.count(), 999'999'999)};
      const int count =
          ::epoll_pwait2(epoll_.value(), events.data(), int{events.size()}, &wait, nullptr);
      for (const auto& event :
           std::span{events}.first(static_cast<std::size_t>(std::max(count, 0)))) {
        hear(event.data.u64);
      }
    } while (Clock::now() < time);
  }

  void hear(std::size_t number) {
    auto& line = lines_[number];
    std::array<std::byte, 4096> buffer;
    const auto size = ::read(line.file.value(), buffer.data(), buffer.size());
    const auto now = Clock::now();
    line.came += static_cast<std::size_t>(std::max<ssize_t>(size, 0));
    while (line.came >= parol6::kTelemetryFrameSize && !line.asked.empty()) {
      line.came -= parol6::kTelemetryFrameSize;
      const auto asked = line.asked.front();
      line.asked.pop_front();
      ++round_.answered;
      round_.took.record(now - asked);
      if (now - asked > kLate) round_.late.push_back({number, asked - start_, now - asked});
    }
  }

  Descriptor epoll_;
  std::vector<Line> lines_;
  Round round_;
  Clock::time_point start_;
};

double milliseconds(Duration time) {
  return std::chrono::duration<double, std::milli>{time}.count();
}

Round measure(std::string_view name, int number,
              const std::function<void(const Served::Tell& tell)>& serve, Duration time) {
  const Served served{serve};
  Client client{served.places()};
  const auto idle = encode(parol6::CommandFrame{.command = parol6::Command::kIdle});
  (void)client.run(idle, 500ms);  // the first client of a terminal is noticed a moment later
  const auto before = served.processor_time();
  auto round = client.run(idle, time);
  round.processor_time = served.processor_time() - before;
  for (const auto& late : round.late) {
    fmt::print("late: {} in round {}, board {} asked at {:.3f} ms: {:.3f} ms\n", name, number,
               late.board, milliseconds(late.at), milliseconds(late.took));
  }
  fmt::print(
      "{} in round {}: {} asked, {} answered, {} late ({:.4f} %), {:.3f} / {:.3f} / {:.3f} ms at "
      "50 "
      "%, 99 % and most, processor {:.0f} ms of {:.0f}\n",
      name, number, round.asked, round.answered, round.late.size(), 100 * round.share_late(),
      milliseconds(round.took.percentile(50)), milliseconds(round.took.percentile(99)),
      milliseconds(round.took.max()), milliseconds(round.processor_time), milliseconds(time));
  std::fflush(stdout);
  return round;
}

bool compare_boards(int rounds, Duration time) {
  std::vector<double> processor;
  double late_boards = 0;
  double late_echoes = 0;
  for (int i = 1; i <= rounds; ++i) {
    const auto echoes = measure("echoes", i, serve_echoes, time);
    const auto boards = measure("boards", i, serve_boards, time);
    processor.push_back(milliseconds(boards.processor_time) / milliseconds(echoes.processor_time));
    late_boards += boards.share_late() / rounds;
    late_echoes += echoes.share_late() / rounds;
  }
  const bool is_late = late_boards > kMostLate * late_echoes;
  fmt::print(
      "{} boards: {:.4f} % of replies later than 1 ms, {:.4f} % of the echoes'; {:.2f} times "
      "their processor time\n",
      kBoards, 100 * late_boards, 100 * late_echoes, middle(processor));
  return !is_late && middle(processor) <= kMostTime;
}

void serve_command(const Served::Tell& tell) {
  kinovazed::emulation::ServerOptions options;
  options.behaviour = kinovazed::emulation::kDocumentedBehaviour;
  options.call_time = {};  // of the arm, which is no matter of hosting
  kinovazed::emulation::Server server{
      kinovazed::emulation::ArmPort{kinovazed::emulation::JacoArm{}}, options};
  auto host = Host::open(make_hosted(std::move(server)), {.tcp = TcpOptions{}}).value();
  tell(host.targets().front().substr(sizeof "tcp:127.0.0.1:" - 1));
  host.run();
}

void serve_echo(const Served::Tell& tell) {
  const test::ListeningSocket listener;
  tell(std::to_string(listener.port()));
  const auto client = listener.accept();
  serve({client.value()}, kCommand.size(), bytes_of(kAccepted));
}

Descriptor connect(const std::string& port) {
  Descriptor socket{::socket(AF_INET, SOCK_STREAM, 0)};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(port)));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket.value(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    fmt::print("nobody listens at {}\n", port);
  }
  test::send_without_delay(socket);
  return socket;
}

/// From the command to its line; what the server says besides is passed over.
Trips command_trips(int socket) {
  LatencyHistogram histogram;
  std::string heard;
  std::array<char, 4096> buffer;
  for (std::size_t i = 0; i < kTrips; ++i) {
    const auto sent = Clock::now();
    (void)!::write(socket, kCommand.data(), kCommand.size());
    for (auto end = std::string::npos; end == std::string::npos; end = heard.find(kAccepted)) {
      pollfd entry{.fd = socket, .events = POLLIN, .revents = 0};
      (void)::poll(&entry, 1, -1);
      const auto size = ::read(socket, buffer.data(), buffer.size());
      if (size <= 0) std::abort();
      heard.append(buffer.data(), static_cast<std::size_t>(size));
    }
    histogram.record(Clock::now() - sent);
    heard.erase(0, heard.find(kAccepted) + kAccepted.size());
  }
  return trips_of(histogram);
}

bool compare_commands(int rounds) {
  const Served server{serve_command};
  const Served bare{serve_echo};
  const auto to_server = connect(server.places().front());
  const auto to_bare = connect(bare.places().front());
  std::array<std::vector<double>, 3> ratios;
  for (int i = 0; i < rounds; ++i) {
    const auto first = command_trips(to_bare.value());
    const auto command = command_trips(to_server.value());
    const auto second = command_trips(to_bare.value());
    ratios[0].push_back(command.median / first.median);
    ratios[1].push_back(command.p99 / first.p99);
    ratios[2].push_back(second.p99 / first.p99);
  }
  fmt::print(
      "KinovaZED: a command to a bare echo {:.2f} at 50 %, {:.2f} at 99 %; echo to echo "
      "{:.2f} at 99 %\n",
      middle(ratios[0]), middle(ratios[1]), middle(ratios[2]));
  return middle(ratios[1]) <= kMostP99;
}

}  // namespace
}  // namespace armjig::testing

int main(int count, char** arguments) {
  const int rounds = count > 1 ? std::stoi(arguments[1]) : 7;
  const int seconds = count > 2 ? std::stoi(arguments[2]) : 10;
  const bool commands = armjig::testing::compare_commands(rounds);
  const bool boards = armjig::testing::compare_boards(rounds, std::chrono::seconds{seconds});
  return commands && boards ? 0 : 1;
}
