// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/supervisor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
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
/// What it hears is a `Motion`, or the new stop after this byte.
constexpr char kNewStop = 'n';
using Packet = std::array<std::byte, 1 + PackedStop::kMostBytes>;

/// The other one may have heard nothing for a while for want of processor time; that is no reason
/// yet to give it up.
bool say(const Descriptor& socket, Bytes message) noexcept {
  constexpr int kPatienceMs = 200;
  const auto sent = [&] {
    return ::send(socket.value(), message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  };
  auto result = sent();
  if (result < 0 && errno == EAGAIN) {
    pollfd ready{.fd = socket.value(), .events = POLLOUT, .revents = 0};
    ::poll(&ready, 1, kPatienceMs);
    result = sent();
  }
  return result == static_cast<ssize_t>(message.size());
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

[[noreturn]] void send_stops(const Lifeline& line, const PackedStop& stop) noexcept {
  for (int i = 0; i < kStops; ++i) {
    stop.send(line);
    ::poll(nullptr, 0, kStopIntervalMs);
  }
  ::_exit(0);
}

[[noreturn]] void supervise(int socket, const Lifeline& line, PackedStop stop) noexcept {
  step_aside();
  close_all_but(socket, line.descriptor);
  (void)!::send(socket, &kReady, 1, MSG_NOSIGNAL);
  auto motion = Supervisor::Motion::kNone;
  const auto end = [&]() {
    ::close(socket);  // first, so that who wakes up meanwhile learns at once that we are gone
    if (motion == Supervisor::Motion::kPossible) send_stops(line, stop);
    ::_exit(0);
  };
  for (;;) {
    pollfd ready{.fd = socket, .events = POLLIN, .revents = 0};
    const bool is_moving = motion == Supervisor::Motion::kPossible;
    if (::poll(&ready, 1, is_moving ? kSilenceMs : -1) == 0) end();
    Packet packet;
    const auto size = ::recv(socket, packet.data(), packet.size(), 0);
    if (size <= 0) end();
    if (packet[0] == std::byte{kNewStop}) {
      stop = PackedStop::of(Bytes{packet}.first(static_cast<std::size_t>(size)).subspan(1));
    } else {
      motion = static_cast<Supervisor::Motion>(packet[0]);
    }
  }
}

}  // namespace

PackedStop::PackedStop(Messages messages) noexcept {
  for (const auto message : messages) {
    assert(size_ + kPrefix + message.size() <= bytes_.size());
    bytes_[size_] = static_cast<std::byte>(message.size() >> 8U);
    bytes_[size_ + 1] = static_cast<std::byte>(message.size());
    std::ranges::copy(message, bytes_.begin() + static_cast<std::ptrdiff_t>(size_ + kPrefix));
    size_ += kPrefix + message.size();
  }
}

PackedStop PackedStop::of(Bytes packed) noexcept {
  PackedStop stop;
  stop.size_ = packed.size();
  std::ranges::copy(packed, stop.bytes_.begin());
  return stop;
}

void PackedStop::send(const Lifeline& line) const noexcept {
  for (auto rest = bytes(); !rest.empty();) {
    const auto size =
        std::to_integer<std::size_t>(rest[0]) << 8U | std::to_integer<std::size_t>(rest[1]);
    line.send(line.descriptor, rest.subspan(kPrefix, size));
    rest = rest.subspan(kPrefix + size);
  }
}

Result<Supervisor> Supervisor::start(const Lifeline& line, Messages stop) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return fail(ErrorCode::kSystem, errno);
  }
  Descriptor theirs{ends[0]};
  Descriptor ours{ends[1]};
  const PackedStop first_stop{stop};
  const int process = ::fork();
  if (process < 0) return fail(ErrorCode::kSystem, errno);
  if (process == 0) supervise(theirs.value(), line, first_stop);
  theirs.close();  // so that its death ends the waiting
  Supervisor supervisor{std::move(ours), process, first_stop};
  if (!supervisor.is_ready()) return fail(ErrorCode::kSystem, ECHILD);
  return supervisor;
}

Supervisor::Supervisor(Descriptor socket, int process, const PackedStop& told) noexcept
    : socket_{std::move(socket)}, process_{process}, told_{told} {}

Supervisor::Supervisor(Supervisor&& other) noexcept
    : socket_{std::move(other.socket_)},
      process_{std::exchange(other.process_, -1)},
      told_{other.told_} {}

Supervisor& Supervisor::operator=(Supervisor&& other) noexcept {
  std::swap(socket_, other.socket_);
  std::swap(process_, other.process_);
  std::swap(told_, other.told_);
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
  const auto packet = static_cast<std::byte>(motion);
  return say(socket_, {&packet, 1});
}

bool Supervisor::tell_stop(Messages stop) noexcept {
  const PackedStop next{stop};
  if (next == told_) return true;
  Packet packet{std::byte{kNewStop}};
  std::ranges::copy(next.bytes(), packet.begin() + 1);
  if (!say(socket_, Bytes{packet}.first(1 + next.bytes().size()))) return false;
  told_ = next;
  return true;
}

}  // namespace armjig
