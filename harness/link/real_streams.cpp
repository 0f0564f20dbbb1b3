// SPDX-License-Identifier: Apache-2.0
#include "harness/link/real_streams.hpp"

#include <fmt/core.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

#include "harness/link/descriptor.hpp"
#include "harness/link/port_around.hpp"
#include "harness/link/tcp_connection.hpp"
#include "harness/link/terminal_settings.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
constexpr Duration kConnectPatience = 3s;

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

tl::unexpected<Problem> problem_of_pty(const std::string& path, const Error& error) {
  return problem_of_open(
      path, error,
      {.absent = hint_for_absent(path),
       .not_allowed = "your user may not open it: 'ls -l' shows its group, often dialout",
       .busy = "close that program; 'fuser' names it",
       .gone = "is the emulator still running?",
       .wrong_kind = "it is not a terminal; give the path that 'armjig emulate' prints"});
}

/// The names of speeds in termios.
constexpr std::pair<std::uint32_t, speed_t> kSpeeds[] = {
    {1200, B1200},         {2400, B2400},         {4800, B4800},         {9600, B9600},
    {19'200, B19200},      {38'400, B38400},      {57'600, B57600},      {115'200, B115200},
    {230'400, B230400},    {460'800, B460800},    {500'000, B500000},    {576'000, B576000},
    {921'600, B921600},    {1'000'000, B1000000}, {1'152'000, B1152000}, {1'500'000, B1500000},
    {2'000'000, B2000000}, {2'500'000, B2500000}, {3'000'000, B3000000}, {3'500'000, B3500000},
    {4'000'000, B4000000}};

void set_line(termios& mode, const SerialLine& line) noexcept {
  for (const auto& [baud, name] : kSpeeds) {
    if (baud == line.baud) ::cfsetspeed(&mode, name);
  }
  if (line.parity != Parity::kNone) mode.c_cflag |= PARENB;
  if (line.parity == Parity::kOdd) mode.c_cflag |= PARODD;
  if (line.stop_bits == 2) mode.c_cflag |= CSTOPB;
}

/// A pseudo-terminal has no parity. The C library calls that an error where nothing else changes.
bool set_mode(int fd, termios mode) noexcept {
  if (::tcsetattr(fd, TCSANOW, &mode) == 0) return true;
  mode.c_cflag &= ~static_cast<tcflag_t>(PARENB | PARODD);
  return errno == EINVAL && ::tcsetattr(fd, TCSANOW, &mode) == 0;
}

/// No echo, no line editing, no flow control: bytes as they are.
bool set_raw(int fd, const SerialLine& line) noexcept {
  termios mode{};
  if (::tcgetattr(fd, &mode) != 0) return false;
  ::cfmakeraw(&mode);
  mode.c_cflag &= ~static_cast<tcflag_t>(PARODD | CSTOPB);
  set_line(mode, line);
  mode.c_cflag |= CLOCAL | CREAD;
  mode.c_cc[VMIN] = 1;
  mode.c_cc[VTIME] = 0;
  return set_mode(fd, mode) && ::tcflush(fd, TCIFLUSH) == 0;
}

/// When nothing else of the program is left, its terminal has its own settings again, which change
/// bytes.
void send_last_raw(int descriptor, Bytes message) noexcept {
  termios mode{};
  if (::tcgetattr(descriptor, &mode) == 0) {
    ::cfmakeraw(&mode);
    ::tcsetattr(descriptor, TCSANOW, &mode);
  }
  send_last(descriptor, message);
}

/// A terminal that has its settings back in the end.
class TerminalStream final : public StreamAround {
 public:
  TerminalStream(std::unique_ptr<StreamPort> inner, TerminalSettings settings) noexcept
      : StreamAround{std::move(inner)}, settings_{std::move(settings)} {}

  Result<void> write(Bytes bytes) override { return inner().write(bytes); }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    return inner().read(into, deadline);
  }
  [[nodiscard]] std::optional<Lifeline> lifeline() const override {
    return Lifeline{StreamAround::lifeline()->descriptor, send_last_raw};
  }

 private:
  TerminalSettings settings_;  // goes before the file does
};

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

Outcome<std::unique_ptr<StreamPort>> open_pty(const std::string& path, SerialLine line) {
  auto terminal = open_terminal(path);
  if (!terminal) return problem_of_pty(path, terminal.error());
  const int file = terminal->value();
  if (const auto session = session_on(file); session != 0) {
    return problem(ErrorCode::kBusy, path,
                   describe_session(session) + "; give the path that 'armjig emulate' prints");
  }
  auto settings = TerminalSettings::keep(file);
  if (!settings) return problem_of_pty(path, settings.error());
  if (!set_raw(file, line)) return problem_of_pty(path, error_from_errno(errno));
  return std::make_unique<TerminalStream>(
      std::make_unique<DescriptorStream>(*std::move(terminal), &write_all), *std::move(settings));
}

Outcome<std::unique_ptr<StreamPort>> open_tcp_stream(std::string_view address) {
  const auto where = parse_tcp_address(address);
  if (!where) return tl::unexpected{where.error()};
  auto socket = connect_tcp(*where, kConnectPatience);
  if (!socket) return problem_of_connect(address, socket.error());
  return std::make_unique<DescriptorStream>(std::move(*socket), &send_all);
}

}  // namespace armjig
