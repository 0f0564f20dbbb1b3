// SPDX-License-Identifier: Apache-2.0
#include "harness/link/real_streams.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "harness/link/descriptor.hpp"
#include "harness/link/tcp_connection.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
constexpr Duration kConnectPatience = 3s;

using Put = Result<void> (*)(const Descriptor&, Bytes, const Stopwatch&, Duration) noexcept;

/// A terminal or a socket; they differ only in how bytes are written.
class DescriptorStream final : public StreamPort {
 public:
  DescriptorStream(Descriptor descriptor, Put put) noexcept
      : descriptor_{std::move(descriptor)}, put_{put} {}

  Result<void> write(Bytes bytes) override {
    return put_(descriptor_, bytes, clock_, kWritePatience);
  }

  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    if (into.empty()) return 0;
    while (true) {
      const auto size = ::read(descriptor_.value(), into.data(), into.size());
      if (size > 0) return static_cast<std::size_t>(size);
      if (size == 0) return fail(ErrorCode::kDisconnected);
      if (errno == ETIMEDOUT) return fail(ErrorCode::kDisconnected, errno);
      if (errno != EAGAIN && errno != EINTR) return tl::unexpected{error_from_errno(errno)};
      const auto is_ready = wait_for(descriptor_, Readiness::kReadable, clock_, deadline);
      if (!is_ready) return tl::unexpected{is_ready.error()};
      if (!*is_ready) return 0;
    }
  }

  [[nodiscard]] Instant now() const override { return clock_.now(); }

  [[nodiscard]] std::optional<int> descriptor() const override { return descriptor_.value(); }

 private:
  Descriptor descriptor_;
  Put put_;
  Stopwatch clock_;
};

/// Where a symbolic link leads; empty for everything else.
std::string link_target(const std::string& path) {
  std::array<char, 4096> text{};
  const auto size = ::readlink(path.c_str(), text.data(), text.size());
  return size < 0 ? std::string{} : std::string{text.data(), static_cast<std::size_t>(size)};
}

std::string hint_for_absent(const std::string& path) {
  const auto target = link_target(path);
  if (!target.empty()) {
    return fmt::format("it is a link to {}, which has gone: is the emulator still running?",
                       target);
  }
  return "is the emulator running, is the board plugged in?";
}

auto not_a_terminal(const std::string& path) {
  return problem(ErrorCode::kBadTarget, path,
                 "it is not a terminal; give the path that 'armjig emulate' prints");
}

tl::unexpected<Problem> problem_of_open(const std::string& path, int error_number) {
  switch (error_number) {
    case ENOENT:
    case ENOTDIR:
    case ENXIO:
    case ENODEV:
      return problem(ErrorCode::kNotFound, path, hint_for_absent(path));
    case EACCES:
    case EPERM:
      return problem(ErrorCode::kNoPermission, path,
                     "your user may not open it: 'ls -l' shows its group, often dialout");
    case EBUSY:
    case EWOULDBLOCK:
      return problem(ErrorCode::kBusy, path, "close that program; 'fuser' names it");
    case EISDIR:
      return not_a_terminal(path);
    case EIO:
      return problem(ErrorCode::kDisconnected, path, "is the emulator still running?");
    default:
      return problem(ErrorCode::kSystem, path, std::generic_category().message(error_number));
  }
}

/// No echo, no line editing, no flow control: bytes as they are.
bool set_raw(int fd) noexcept {
  termios mode{};
  if (::tcgetattr(fd, &mode) != 0) return false;
  ::cfmakeraw(&mode);
  mode.c_cflag |= CLOCAL | CREAD;
  mode.c_cc[VMIN] = 1;
  mode.c_cc[VTIME] = 0;
  return ::tcsetattr(fd, TCSANOW, &mode) == 0 && ::tcflush(fd, TCIFLUSH) == 0;
}

auto problem_of_connect(std::string_view address, const Error& error) {
  const auto hint = [&error]() -> std::string {
    switch (error.code) {
      case ErrorCode::kNotFound:
        return "no such host is known, or there is no way to it";
      case ErrorCode::kRefused:
        return "nothing listens there: is it started, is the port right?";
      case ErrorCode::kTimedOut:
        return "the host does not answer: is it on, is the port open?";
      default:
        return std::generic_category().message(error.detail);
    }
  };
  return problem(error.code, fmt::format("tcp:{}", address), hint());
}

}  // namespace

Outcome<std::unique_ptr<StreamPort>> open_pty(const std::string& path) {
  Descriptor terminal{::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
  if (!terminal.is_open()) return problem_of_open(path, errno);
  if (::isatty(terminal.value()) == 0) return not_a_terminal(path);
  if (::flock(terminal.value(), LOCK_EX | LOCK_NB) != 0) return problem_of_open(path, errno);
  if (!set_raw(terminal.value())) return problem_of_open(path, errno);
  return std::make_unique<DescriptorStream>(std::move(terminal), &write_all);
}

Outcome<std::unique_ptr<StreamPort>> open_tcp_stream(std::string_view address) {
  const auto where = parse_tcp_address(address);
  if (!where) return tl::unexpected{where.error()};
  auto socket = connect_tcp(*where, kConnectPatience);
  if (!socket) return problem_of_connect(address, socket.error());
  return std::make_unique<DescriptorStream>(std::move(*socket), &send_all);
}

}  // namespace armjig
