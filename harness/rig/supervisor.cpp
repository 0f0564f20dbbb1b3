// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/supervisor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <climits>
#include <csignal>
#include <utility>

namespace armjig {
namespace {

constexpr int kSilenceMs = 500;
/// The stop leaves every 10 ms for a second: a device that restarts needs 0.74 s before it hears
/// anything.
constexpr int kStops = 100;
constexpr int kStopIntervalMs = 10;
/// Not the name of the program: `killall` must not find it.
constexpr auto kName = "arm-supervisor";

/// Its first word, when nothing can disturb it any more.
constexpr char kReady = 'r';
/// What it hears is a `Motion`, or the new stop behind this byte.
constexpr char kNewStop = 'n';
using MessageBytes = std::array<char, 1 + Supervisor::kMostStopBytes>;

/// What the supervisor knows; no heap behind it.
struct Stop {
  std::array<std::byte, Supervisor::kMostStopBytes> bytes{};
  std::size_t size = 0;

  void set(Bytes stop) noexcept {
    size = std::min(stop.size(), bytes.size());
    std::copy_n(stop.begin(), size, bytes.begin());
  }
};

/// The other one may have heard nothing for a while for want of processor time; that is no reason
/// yet to give it up.
bool say(const Descriptor& socket, const char* message, std::size_t size) noexcept {
  constexpr int kPatienceMs = 200;
  const auto sent = [&] {
    return ::send(socket.value(), message, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  };
  auto result = sent();
  if (result < 0 && errno == EAGAIN) {
    pollfd ready{.fd = socket.value(), .events = POLLOUT, .revents = 0};
    ::poll(&ready, 1, kPatienceMs);
    result = sent();
  }
  return result == static_cast<ssize_t>(size);
}

// From here to `supervise`: only what is safe in a process that was forked, which is system calls.

/// Files of the parent, the sockets of other supervisors among them, must not live on in this one.
void close_all_but(int one, int other) noexcept {
  const auto low = static_cast<unsigned>(std::min(one, other));
  const auto high = static_cast<unsigned>(std::max(one, other));
  const auto close_from_to = [](unsigned first, unsigned last) {
    if (first > last) return;
    if (::close_range(first, last, 0) == 0) return;
    constexpr unsigned kMostDescriptors = 4096;  // the kernel is older than 5.9
    for (auto fd = first; fd <= std::min(last, kMostDescriptors); ++fd)
      ::close(static_cast<int>(fd));
  };
  if (low > 0) close_from_to(0, low - 1);
  close_from_to(low + 1, high - 1);
  close_from_to(high + 1, UINT_MAX);
}

void step_aside() noexcept {
  sigset_t all;
  ::sigfillset(&all);
  ::sigprocmask(SIG_BLOCK, &all, nullptr);
  ::setsid();
  ::prctl(PR_SET_NAME, kName);
}

[[noreturn]] void send_stops(int port, const Stop& stop) noexcept {
  std::array<std::byte, 4096> ignored;
  for (int i = 0; i < kStops; ++i) {
    // Errors and short writes are met by trying again; nothing else could be done here.
    (void)!::write(port, stop.bytes.data(), stop.size);
    ::poll(nullptr, 0, kStopIntervalMs);
    (void)!::read(port, ignored.data(), ignored.size());  // else the board's answers pile up
  }
  ::_exit(0);
}

[[noreturn]] void supervise(int socket, int port, Stop stop) noexcept {
  step_aside();
  close_all_but(socket, port);
  (void)!::send(socket, &kReady, 1, MSG_NOSIGNAL);
  auto motion = Supervisor::Motion::kNone;
  const auto end = [&]() {
    ::close(socket);  // first, so that who wakes up meanwhile learns at once that we are gone
    if (motion == Supervisor::Motion::kPossible) send_stops(port, stop);
    ::_exit(0);
  };
  for (;;) {
    pollfd ready{.fd = socket, .events = POLLIN, .revents = 0};
    const bool is_moving = motion == Supervisor::Motion::kPossible;
    if (::poll(&ready, 1, is_moving ? kSilenceMs : -1) == 0) end();
    MessageBytes message;
    const auto size = ::recv(socket, message.data(), message.size(), 0);
    if (size <= 0) end();
    const auto content = std::as_bytes(std::span{message}).first(static_cast<std::size_t>(size));
    if (message[0] == kNewStop) {
      stop.set(content.subspan(1));
    } else {
      motion = static_cast<Supervisor::Motion>(message[0]);
    }
  }
}

}  // namespace

Result<Supervisor> Supervisor::start(int port, Bytes stop) {
  assert(stop.size() <= kMostStopBytes);
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return fail(ErrorCode::kSystem, errno);
  }
  Descriptor theirs{ends[0]};
  Descriptor ours{ends[1]};
  Stop first_stop;
  first_stop.set(stop);
  const int process = ::fork();
  if (process < 0) return fail(ErrorCode::kSystem, errno);
  if (process == 0) supervise(theirs.value(), port, first_stop);
  theirs.close();  // so that its death ends the waiting
  Supervisor supervisor{std::move(ours), process};
  if (!supervisor.is_ready()) return fail(ErrorCode::kSystem, ECHILD);
  return supervisor;
}

Supervisor::Supervisor(Descriptor socket, int process) noexcept
    : socket_{std::move(socket)}, process_{process} {}

Supervisor::Supervisor(Supervisor&& other) noexcept
    : socket_{std::move(other.socket_)}, process_{std::exchange(other.process_, -1)} {}

Supervisor& Supervisor::operator=(Supervisor&& other) noexcept {
  std::swap(socket_, other.socket_);
  std::swap(process_, other.process_);
  return *this;
}

Supervisor::~Supervisor() {
  socket_.close();
  while (process_ > 0 && ::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool Supervisor::is_ready() const noexcept {
  char word{};
  ssize_t size = 0;
  do {
    size = ::recv(socket_.value(), &word, 1, 0);
  } while (size < 0 && errno == EINTR);
  return size == 1 && word == kReady;
}

bool Supervisor::tell(Motion motion) noexcept {
  const auto message = static_cast<char>(motion);
  return say(socket_, &message, 1);
}

bool Supervisor::tell_stop(Bytes stop) noexcept {
  assert(stop.size() <= kMostStopBytes);
  MessageBytes message;
  message[0] = kNewStop;
  const auto* const first = reinterpret_cast<const char*>(stop.data());
  std::copy_n(first, stop.size(), message.data() + 1);
  return say(socket_, message.data(), 1 + stop.size());
}

}  // namespace armjig
