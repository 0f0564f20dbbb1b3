// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/supervisor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <utility>

namespace armjig {
namespace {

/// What goes through the pipe.
enum Message : char { kStands = 's', kMayMove = 'm', kFarewell = 'f' };

constexpr int kSilenceMs = 500;
/// The stop leaves every 10 ms for a second: a device in the middle of a broken message may swallow
/// some, and one that restarts needs 0.74 s before it hears anything.
constexpr int kStops = 100;
constexpr int kStopIntervalMs = 10;

/// False if nobody listens any more. A full pipe is no harm: what is in it says the same.
bool say(const Descriptor& pipe, Message message) noexcept {
  const char byte = message;
  const auto size = ::send(pipe.value(), &byte, 1, MSG_NOSIGNAL | MSG_DONTWAIT);
  return size == 1 || errno == EAGAIN;
}

/// Only what is safe in a process that was forked: system calls.
[[noreturn]] void send_stops(int port, const std::vector<std::byte>& stop) {
  std::array<std::byte, 4096> ignored;
  for (int i = 0; i < kStops; ++i) {
    // Errors and short writes are met by trying again; nothing else could be done here.
    (void)!::write(port, stop.data(), stop.size());
    ::poll(nullptr, 0, kStopIntervalMs);
    (void)!::read(port, ignored.data(), ignored.size());  // else the board's answers pile up
  }
  ::_exit(0);
}

[[noreturn]] void supervise(int pipe, int port, const std::vector<std::byte>& stop) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE}) ::signal(signal, SIG_IGN);
  bool may_be_moving = false;
  for (;;) {
    pollfd ready{.fd = pipe, .events = POLLIN, .revents = 0};
    const int count = ::poll(&ready, 1, may_be_moving ? kSilenceMs : -1);
    if (count < 0 && errno == EINTR) continue;
    if (count == 0) send_stops(port, stop);
    std::array<char, 256> messages;
    const auto size = ::read(pipe, messages.data(), messages.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) {
      if (may_be_moving) send_stops(port, stop);
      ::_exit(0);
    }
    const char last = messages[static_cast<std::size_t>(size - 1)];
    if (last == kFarewell) ::_exit(0);
    may_be_moving = last == kMayMove;
  }
}

}  // namespace

Result<Supervisor> Supervisor::start(int port, std::vector<std::byte> stop) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return fail(ErrorCode::kSystem, errno);
  }
  Descriptor reading{ends[0]};
  Descriptor writing{ends[1]};
  const int process = ::fork();
  if (process < 0) return fail(ErrorCode::kSystem, errno);
  if (process == 0) {
    ::close(writing.value());  // else the pipe would never end
    supervise(reading.value(), port, stop);
  }
  return Supervisor{std::move(writing), process};
}

Supervisor::Supervisor(Descriptor pipe, int process) noexcept
    : pipe_{std::move(pipe)}, process_{process} {}

Supervisor::~Supervisor() {
  if (!pipe_.is_open()) return;
  (void)say(pipe_, kFarewell);
  pipe_.close();
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool Supervisor::tell(bool may_be_moving) noexcept {
  return say(pipe_, may_be_moving ? kMayMove : kStands);
}

}  // namespace armjig
