// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/path.hpp"

#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>

namespace armjig {
namespace {

using namespace std::chrono_literals;

Duration duration_of(const timespec& time) noexcept {
  return std::chrono::seconds{time.tv_sec} + Duration{time.tv_nsec};
}

/// What stamps of the kernel are.
Duration wall_clock() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);  // in user space, as steady_clock
  return duration_of(now);
}

/// What the kernel says of a message, if it does.
std::optional<Duration> stamp_in(msghdr& message) noexcept {
  for (auto* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPING) continue;
    scm_timestamping stamps{};
    std::memcpy(&stamps, CMSG_DATA(part), sizeof stamps);
    if (stamps.ts[0].tv_sec == 0) continue;
    return duration_of({stamps.ts[0].tv_sec, stamps.ts[0].tv_nsec});
  }
  return std::nullopt;
}

Result<Path::Arrival> read_from(StreamPort& port, std::span<std::byte> into, Instant deadline) {
  return port.read(into, deadline).map([&](std::size_t size) {
    return Path::Arrival{size, port.now()};
  });
}

class PortPath final : public Path {
 public:
  explicit PortPath(StreamPort& port) : port_{port} {}

  Instant now() const override { return port_.now(); }
  Result<Arrival> drain(std::span<std::byte> into) override { return receive(into, port_.now()); }
  Result<void> send(Bytes message) override { return port_.write(message); }
  Result<Arrival> receive(std::span<std::byte> into, Instant deadline) override {
    return read_from(port_, into, deadline);
  }
  std::string_view name() const noexcept override { return "the port with its layers"; }

 private:
  StreamPort& port_;
};

class FilePath final : public Path {
 public:
  FilePath(StreamPort& port, const DirectLine& line) : port_{port}, line_{line} {
    int type = 0;
    socklen_t size = sizeof type;
    is_socket_ = ::getsockopt(line.descriptor, SOL_SOCKET, SO_TYPE, &type, &size) == 0;
    has_stamps_ = is_socket_ && ask_for_stamps(kOfWhatComes);
  }

  Instant now() const override { return port_.now(); }
  Result<void> announce(Bytes message) override {
    auto admitted = line_.guard->announce(message);
    if (admitted) admitted_ += message.size();
    return admitted;
  }
  Result<Arrival> drain(std::span<std::byte> into) override {
    return read_from(port_, into, port_.now());
  }
  void overhear(Bytes bytes) override { line_.guard->overhear(bytes); }
  std::string_view name() const noexcept override {
    if (has_stamps_) return "poll, recvmsg, send; SO_TIMESTAMPING";
    return is_socket_ ? "poll, recvmsg, send" : "poll, read, write";
  }

  Result<void> send(Bytes message) override {
    if (message.size() > admitted_) return fail(ErrorCode::kForbidden);
    admitted_ -= message.size();
    while (!message.empty()) {
      const auto sent = is_socket_
                            ? ::send(line_.descriptor, message.data(), message.size(), MSG_NOSIGNAL)
                            : ::write(line_.descriptor, message.data(), message.size());
      if (sent > 0) {
        message = message.subspan(static_cast<std::size_t>(sent));
      } else if (sent < 0 && errno == EAGAIN) {
        const auto can = wait(Readiness::kWritable, port_.now() + kPatience);
        if (!can) return tl::unexpected{can.error()};
        if (!*can) return fail(ErrorCode::kTimedOut);
      } else if (sent < 0 && errno != EINTR) {
        return tl::unexpected{gone(errno)};
      }
    }
    return {};
  }

  Result<std::optional<Duration>> time_send(Bytes message) override {
    if (!has_stamps_ || !ask_for_stamps(kOfWhatComes | kOfWhatLeaves))
      return Path::time_send(message);
    const auto called = wall_clock();
    const auto sent = send(message);
    auto left = sent ? stamp_of_sent() : std::nullopt;
    (void)ask_for_stamps(kOfWhatComes);
    if (!sent) return tl::unexpected{sent.error()};
    if (left) *left -= called;
    return left;
  }

  Result<Arrival> receive(std::span<std::byte> into, Instant deadline) override {
    for (;;) {
      const auto has_come = wait(Readiness::kReadable, deadline);
      if (!has_come) return tl::unexpected{has_come.error()};
      if (!*has_come) return Arrival{0, port_.now()};
      Arrival arrival;
      const auto size = is_socket_ ? read_socket(into, arrival)
                                   : ::read(line_.descriptor, into.data(), into.size());
      if (!arrival.kernel) arrival.time = port_.now();
      arrival.size = static_cast<std::size_t>(std::max<ssize_t>(size, 0));
      if (size > 0) return arrival;
      if (size == 0) return fail(ErrorCode::kDisconnected);
      if (errno != EAGAIN && errno != EINTR) return tl::unexpected{gone(errno)};
    }
  }

 private:
  static constexpr Duration kPatience = 2s;
  static constexpr Duration kUntilStamped = 50ms;
  static constexpr int kOfWhatComes = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
  static constexpr int kOfWhatLeaves = SOF_TIMESTAMPING_TX_SOFTWARE | SOF_TIMESTAMPING_OPT_TSONLY;

  bool ask_for_stamps(int flags) const noexcept {
    return ::setsockopt(line_.descriptor, SOL_SOCKET, SO_TIMESTAMPING, &flags, sizeof flags) == 0;
  }

  /// When the last byte left, since 1970; all that is in the error queue is taken out.
  std::optional<Duration> stamp_of_sent() const noexcept {
    std::optional<Duration> stamp;
    const auto has_any = wait_for(line_.descriptor, {}, [] { return kUntilStamped; });
    if (!has_any || !*has_any) return stamp;
    alignas(cmsghdr) std::array<std::byte, 256> control;
    msghdr message{};
    message.msg_control = control.data();
    for (;;) {
      message.msg_controllen = control.size();
      if (::recvmsg(line_.descriptor, &message, MSG_ERRQUEUE | MSG_DONTWAIT) < 0) return stamp;
      if (const auto one = stamp_in(message)) stamp = one;
    }
  }

  static Error gone(int error_number) noexcept {
    if (error_number == EIO) return {ErrorCode::kDisconnected, error_number};
    return error_from_errno(error_number);
  }

  Result<bool> wait(Readiness readiness, Instant deadline) const noexcept {
    return wait_for(line_.descriptor, readiness,
                    [&] { return std::max(deadline - port_.now(), Duration{}); });
  }

  ssize_t read_socket(std::span<std::byte> into, Arrival& arrival) const noexcept {
    iovec place{.iov_base = into.data(), .iov_len = into.size()};
    alignas(cmsghdr) std::array<std::byte, 256> control;
    msghdr message{};
    message.msg_iov = &place;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const auto size = ::recvmsg(line_.descriptor, &message, 0);
    if (size <= 0 || !has_stamps_) return size;
    arrival.time = port_.now();
    const auto wall = wall_clock();
    if (const auto stamp = stamp_in(message)) {
      arrival.kernel = arrival.time - std::max(wall - *stamp, Duration{});
    }
    return size;
  }

  StreamPort& port_;
  DirectLine line_;
  std::size_t admitted_ = 0;  ///< bytes that the guard said yes to, and that are not sent
  bool is_socket_ = false;
  bool has_stamps_ = false;
};

}  // namespace

std::unique_ptr<Path> path_through(StreamPort& port) { return std::make_unique<PortPath>(port); }

std::unique_ptr<Path> path_on(StreamPort& port, const DirectLine& line) {
  return std::make_unique<FilePath>(port, line);
}

}  // namespace armjig
