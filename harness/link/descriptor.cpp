// SPDX-License-Identifier: Apache-2.0
#include "harness/link/descriptor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
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

/// What was there and is not any more was unplugged.
tl::unexpected<Error> in_use(Error error) noexcept {
  const bool is_gone = error.code == ErrorCode::kNotFound || error.code == ErrorCode::kTimedOut;
  if (is_gone && error.detail != 0) error.code = ErrorCode::kDisconnected;
  return tl::unexpected{error};
}

}  // namespace

void Descriptor::close() noexcept {
  if (is_open()) ::close(std::exchange(fd_, -1));
}

Result<bool> wait_for(const Descriptor& descriptor, Readiness readiness, const Stopwatch& clock,
                      Instant deadline) noexcept {
  return wait_for(descriptor.value(), readiness, [&] { return remaining(clock, deadline); });
}

Result<bool> wait_for(int descriptor, std::optional<Readiness> readiness,
                      const std::function<Duration()>& left) noexcept {
  short events = 0;
  if (readiness) events = *readiness == Readiness::kReadable ? POLLIN : POLLOUT;
  while (true) {
    pollfd entry{.fd = descriptor, .events = events, .revents = 0};
    // Not poll(): its milliseconds would round every deadline up.
    const auto timeout = as_timespec(left());
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

Result<Descriptor> open_terminal(const std::string& path) noexcept {
  Descriptor terminal{::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
  const bool is_folder = !terminal.is_open() && errno == EISDIR;
  if (is_folder) return fail(ErrorCode::kBadTarget);
  if (terminal.is_open() && ::isatty(terminal.value()) == 0) {
    // One that is pulled out right now is hung up.
    return fail(errno == EIO ? ErrorCode::kDisconnected : ErrorCode::kBadTarget);
  }
  if (!terminal.is_open()) return tl::unexpected{error_from_errno(errno)};
  if (::flock(terminal.value(), LOCK_EX | LOCK_NB) == 0) return terminal;
  return tl::unexpected{error_from_errno(errno == EWOULDBLOCK ? EBUSY : errno)};
}

tl::unexpected<Problem> problem_of_open(const std::string& path, const Error& error,
                                        const OpenHints& hints) {
  switch (error.code) {
    case ErrorCode::kNotFound:
      return problem(error.code, path, hints.absent);
    case ErrorCode::kNoPermission:
      return problem(error.code, path, hints.not_allowed);
    case ErrorCode::kBusy:
      return problem(error.code, path, hints.busy);
    case ErrorCode::kDisconnected:
      return problem(error.code, path, hints.gone);
    case ErrorCode::kBadTarget:
      return problem(error.code, path, hints.wrong_kind);
    default:
      return problem(ErrorCode::kSystem, path, std::generic_category().message(error.detail));
  }
}

void send_last(int descriptor, Bytes message) noexcept {
  std::array<std::byte, 4096> ignored;
  (void)!::read(descriptor, ignored.data(), ignored.size());
  (void)!::write(descriptor, message.data(), message.size());
}

Result<void> DescriptorStream::write(Bytes bytes) {
  auto written = put_(descriptor_, bytes, clock_, kWritePatience);
  if (!written) return in_use(written.error());
  return written;
}

Result<std::size_t> DescriptorStream::read(std::span<std::byte> into, Instant deadline) {
  if (into.empty()) return 0;
  while (true) {
    const auto is_ready = wait_for(descriptor_, Readiness::kReadable, clock_, deadline);
    if (!is_ready) return tl::unexpected{is_ready.error()};
    if (!*is_ready) return 0;
    // libserialport lets `read` answer 0 when nothing has come; but something has, so it is gone.
    const auto size = ::read(descriptor_.value(), into.data(), into.size());
    if (size > 0) return static_cast<std::size_t>(size);
    if (size == 0) return fail(ErrorCode::kDisconnected);
    if (errno != EAGAIN && errno != EINTR) return in_use(error_from_errno(errno));
  }
}

}  // namespace armjig
