// SPDX-License-Identifier: Apache-2.0
#include "harness/link/descriptor.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace armjig {
namespace {

timespec as_timespec(Duration duration) noexcept {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(duration);
  timespec result{};
  result.tv_sec = static_cast<time_t>(seconds.count());
  result.tv_nsec = static_cast<long>((duration - seconds).count());
  return result;
}

Duration remaining(const Stopwatch& clock, Instant deadline) noexcept {
  const auto now = clock.now();
  return deadline > now ? deadline - now : Duration::zero();
}

/// `put` is `send` or `write`, which differ in what a broken socket does: a signal or an errno.
template <class Put>
Result<void> put_all(const Descriptor& descriptor, Bytes bytes, const Stopwatch& clock,
                     Duration patience, Put put) noexcept {
  auto deadline = clock.now() + patience;
  while (!bytes.empty()) {
    const auto taken = put(bytes);
    if (taken > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(taken));
      deadline = clock.now() + patience;
    } else if (taken < 0 && errno == EAGAIN) {
      const auto is_ready = wait_for(descriptor, Readiness::kWritable, clock, deadline);
      if (!is_ready) return tl::unexpected{is_ready.error()};
      if (!*is_ready) return fail(ErrorCode::kTimedOut);
    } else if (taken < 0 && errno != EINTR) {
      return tl::unexpected{error_from_errno(errno)};
    }
  }
  return {};
}

}  // namespace

void Descriptor::close() noexcept {
  if (is_open()) ::close(std::exchange(fd_, -1));
}

Result<bool> wait_for(const Descriptor& descriptor, Readiness readiness, const Stopwatch& clock,
                      Instant deadline) noexcept {
  const short events = readiness == Readiness::kReadable ? POLLIN : POLLOUT;
  while (true) {
    pollfd entry{.fd = descriptor.value(), .events = events, .revents = 0};
    // Not poll(): its milliseconds would round every deadline up.
    const auto timeout = as_timespec(remaining(clock, deadline));
    const auto ready = ::ppoll(&entry, 1, &timeout, nullptr);
    if (ready >= 0) return ready > 0;
    if (errno != EINTR) return fail(ErrorCode::kSystem, errno);
  }
}

Result<void> send_all(const Descriptor& socket, Bytes bytes, const Stopwatch& clock,
                      Duration patience) noexcept {
  return put_all(socket, bytes, clock, patience, [&socket](Bytes rest) {
    return ::send(socket.value(), rest.data(), rest.size(), MSG_NOSIGNAL);
  });
}

Result<void> write_all(const Descriptor& terminal, Bytes bytes, const Stopwatch& clock,
                       Duration patience) noexcept {
  return put_all(terminal, bytes, clock, patience, [&terminal](Bytes rest) {
    return ::write(terminal.value(), rest.data(), rest.size());
  });
}

}  // namespace armjig
