// SPDX-License-Identifier: Apache-2.0
#include "harness/link/real_streams.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "emulators/host/pseudo_terminal.hpp"
#include "harness/link/descriptor.hpp"
#include "harness/link/tcp_connection.hpp"
#include "tests/integration/support/program.hpp"
#include "tests/integration/support/sockets.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::Listener;

std::string read_text(StreamPort& port, std::size_t size) {
  std::string text;
  const auto deadline = port.now() + testing::kPatience;
  std::array<std::byte, 256> buffer;
  while (text.size() < size) {
    const auto got =
        port.read(std::span{buffer}.first(std::min(buffer.size(), size - text.size())), deadline);
    if (!got || *got == 0) break;
    for (const auto byte : std::span{buffer}.first(*got)) text += static_cast<char>(byte);
  }
  return text;
}

Bytes bytes_of(std::string_view text) { return std::as_bytes(std::span{text}); }

/// What must be said of a target that cannot be opened.
void expect_problem(const Outcome<std::unique_ptr<StreamPort>>& outcome, ErrorCode code,
                    const std::string& hint) {
  ASSERT_FALSE(outcome.has_value());
  EXPECT_EQ(outcome.error().code, code) << describe(outcome.error());
  EXPECT_THAT(outcome.error().hint, HasSubstr(hint));
}

/// A folder of its own for each test.
class PtyStream : public ::testing::Test {
 protected:
  PtyStream() {
    auto pattern = (std::filesystem::temp_directory_path() / "armjig-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~PtyStream() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(std::string_view name) const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

/// A terminal as a shell leaves it, its other end, and the settings that it has.
struct Cooked {
  Cooked() {
    ::grantpt(master.value());
    ::unlockpt(master.value());
    path = ::ptsname(master.value());
    slave = Descriptor{::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)};
    before = settings();
  }
  [[nodiscard]] termios settings() const {
    termios now{};
    ::tcgetattr(slave.value(), &now);
    return now;
  }
  [[nodiscard]] bool is_as_before() const {
    const auto now = settings();
    return now.c_iflag == before.c_iflag && now.c_oflag == before.c_oflag &&
           now.c_cflag == before.c_cflag && now.c_lflag == before.c_lflag;
  }

  Descriptor master{::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)};
  Descriptor slave;
  std::string path;
  termios before{};
};

TEST_F(PtyStream, GivesTheTerminalItsSettingsBack) {
  const Cooked terminal;
  auto port = open_pty(terminal.path);
  ASSERT_TRUE(port) << describe(port.error());
  EXPECT_FALSE(terminal.is_as_before());
  port->reset();
  EXPECT_TRUE(terminal.is_as_before());
}

TEST_F(PtyStream, GivesThemBackWhenASignalEndsTheProgram) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const Cooked terminal;
    const auto child = ::fork();
    if (child == 0) {
      ::signal(signal, SIG_DFL);
      const auto port = open_pty(terminal.path);
      if (!port || terminal.is_as_before()) ::_exit(1);
      ::raise(signal);
      ::_exit(2);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
    EXPECT_TRUE(terminal.is_as_before()) << signal;
  }
}

TEST_F(PtyStream, StopsADeviceWithoutTheTerminalsOwnSettings) {
  const Cooked terminal;
  auto port = open_pty(terminal.path);
  ASSERT_TRUE(port);
  const auto line = (*port)->lifeline();
  ASSERT_TRUE(line);
  ::tcsetattr(terminal.slave.value(), TCSANOW, &terminal.before);
  line->send(line->descriptor, bytes_of("a\nb"));
  std::array<char, 16> got{};
  const auto size = ::read(terminal.master.value(), got.data(), got.size());
  EXPECT_EQ(std::string(got.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))), "a\nb");
}

TEST_F(PtyStream, IsNotATerminalOnWhichSomebodyWorks) {
  const Cooked terminal;
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const auto child = ::fork();
  if (child == 0) {
    ::setsid();
    ::ioctl(terminal.slave.value(), TIOCSCTTY, 0);
    const auto own = open_pty(terminal.path);
    const char answer = !own && own.error().code == ErrorCode::kBusy ? 'y' : 'n';
    (void)!::write(pipe[1], &answer, 1);
    ::pause();
    ::_exit(0);
  }
  char answer{};
  ASSERT_EQ(::read(pipe[0], &answer, 1), 1);
  EXPECT_EQ(answer, 'y') << "its own";
  expect_problem(open_pty(terminal.path), ErrorCode::kBusy,
                 "it is the terminal of process " + std::to_string(child));
  EXPECT_TRUE(terminal.is_as_before());
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST_F(PtyStream, CarriesEveryByteValueBothWaysUnchanged) {
  const auto terminal = PseudoTerminal::open();
  ASSERT_TRUE(terminal);
  const auto port = open_pty(terminal->path());
  ASSERT_TRUE(port);
  std::string all(256, '\0');
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<char>(i);
  const Stopwatch clock;
  ASSERT_TRUE(write_all(terminal->master(), bytes_of(all), clock, 1s));
  EXPECT_EQ(read_text(**port, all.size()), all);
  ASSERT_TRUE((*port)->write(bytes_of(all)));
  std::string read(all.size(), '\0');
  ASSERT_EQ(::read(terminal->master().value(), read.data(), read.size()), 256);
  EXPECT_EQ(read, all);
}

TEST_F(PtyStream, WaitsForTheDeadlineAndNoLonger) {
  const auto terminal = PseudoTerminal::open();
  const auto port = open_pty(terminal->path());
  ASSERT_TRUE(port);
  std::array<std::byte, 8> buffer;
  const auto deadline = (*port)->now() + 5ms;
  const auto size = (*port)->read(buffer, deadline);
  ASSERT_TRUE(size);
  EXPECT_EQ(*size, 0U);
  EXPECT_GE((*port)->now(), deadline);
}

TEST_F(PtyStream, SaysThatTheOtherSideHasGone) {
  auto terminal = PseudoTerminal::open();
  const auto port = open_pty(terminal->path());
  ASSERT_TRUE(port);
  {
    const auto gone = std::move(*terminal);
  }
  std::array<std::byte, 8> buffer;
  const auto size = (*port)->read(buffer, (*port)->now() + testing::kPatience);
  ASSERT_FALSE(size);
  EXPECT_EQ(size.error().code, ErrorCode::kDisconnected);
  const auto written = (*port)->write(bytes_of("x"));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kDisconnected);
}

TEST_F(PtyStream, GivesUpWritingToWhoNeverReads) {
  const auto terminal = PseudoTerminal::open();
  const auto port = open_pty(terminal->path());
  ASSERT_TRUE(port);
  const std::string much(std::size_t{1} << 20, 'x');
  const auto written = (*port)->write(bytes_of(much));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kTimedOut);
}

TEST_F(PtyStream, StartsWithoutWhatCameBefore) {
  const auto terminal = PseudoTerminal::open();
  ASSERT_EQ(::write(terminal->master().value(), "stale", 5), 5);
  const auto port = open_pty(terminal->path());
  ASSERT_TRUE(port);
  ASSERT_EQ(::write(terminal->master().value(), "fresh", 5), 5);
  EXPECT_EQ(read_text(**port, 5), "fresh");
}

TEST_F(PtyStream, IsForOneProgramAtATime) {
  const auto terminal = PseudoTerminal::open();
  const auto first = open_pty(terminal->path());
  ASSERT_TRUE(first);
  expect_problem(open_pty(terminal->path()), ErrorCode::kBusy, "fuser");
}

TEST_F(PtyStream, IsFreeAgainAfterClosing) {
  const auto terminal = PseudoTerminal::open();
  ASSERT_TRUE(open_pty(terminal->path()));
  EXPECT_TRUE(open_pty(terminal->path()));
}

// The C library calls it an error when parity is all that would change, and a terminal of this kind
// has none.
TEST_F(PtyStream, CanBeOpenedAgainWithParity) {
  const auto terminal = PseudoTerminal::open();
  ASSERT_TRUE(terminal);
  for (int i = 0; i < 3; ++i) {
    const auto port = open_pty(terminal->path(), {.baud = 1200, .parity = Parity::kEven});
    EXPECT_TRUE(port) << describe(port.error());
  }
}

TEST_F(PtyStream, SaysThatNothingIsThere) {
  expect_problem(open_pty(path("none")), ErrorCode::kNotFound, "is the emulator running");
}

TEST_F(PtyStream, NamesTheTargetOfADanglingLink) {
  std::filesystem::create_symlink("/dev/pts/99999", path("link"));
  expect_problem(open_pty(path("link")), ErrorCode::kNotFound, "/dev/pts/99999");
}

TEST_F(PtyStream, SaysThatAFileIsNotATerminal) {
  std::ofstream{path("file")} << "text";
  expect_problem(open_pty(path("file")), ErrorCode::kBadTarget, "not a terminal");
  expect_problem(open_pty(path("")), ErrorCode::kBadTarget, "not a terminal");
}

TEST_F(PtyStream, SaysThatPermissionIsMissing) {
  const auto terminal = PseudoTerminal::open();
  ASSERT_EQ(::chmod(terminal->path().c_str(), 0), 0);
  const auto child = ::fork();
  if (child == 0) {  // root may open everything
    const bool is_nobody = ::getuid() != 0 || ::setuid(65534) == 0;
    const auto port = open_pty(terminal->path());
    const bool is_refused = !port && port.error().code == ErrorCode::kNoPermission;
    ::_exit(is_nobody && is_refused ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(TcpStream, CarriesBytesBothWays) {
  const Listener listener;
  const auto port = open_tcp_stream(listener.address());
  ASSERT_TRUE(port);
  const auto peer = listener.accept();
  ASSERT_TRUE((*port)->write(bytes_of("question")));
  EXPECT_EQ(testing::receive_plain(peer, 8), "question");
  testing::send_plain(peer, bytes_of("answer"));
  EXPECT_EQ(read_text(**port, 6), "answer");
}

TEST(TcpStream, DeliversWhatWasSentBeforeTheEnd) {
  const Listener listener;
  const auto port = open_tcp_stream(listener.address());
  ASSERT_TRUE(port);
  auto peer = listener.accept();
  testing::send_plain(peer, bytes_of("last words"));
  peer.close();
  EXPECT_EQ(read_text(**port, 10), "last words");
  std::array<std::byte, 8> buffer;
  const auto size = (*port)->read(buffer, (*port)->now() + testing::kPatience);
  ASSERT_FALSE(size);
  EXPECT_EQ(size.error().code, ErrorCode::kDisconnected);
}

TEST(TcpStream, SaysThatAResetIsAnEnd) {
  const Listener listener;
  const auto port = open_tcp_stream(listener.address());
  ASSERT_TRUE(port);
  auto peer = listener.accept();
  testing::close_with_reset(peer);
  std::array<std::byte, 8> buffer;
  const auto size = (*port)->read(buffer, (*port)->now() + testing::kPatience);
  ASSERT_FALSE(size);
  EXPECT_EQ(size.error().code, ErrorCode::kDisconnected);
}

TEST(TcpStream, SaysThatNothingListens) {
  const auto address = Listener{}.address();  // free again at once
  expect_problem(open_tcp_stream(address), ErrorCode::kRefused, "nothing listens");
}

TEST(TcpStream, SaysThatAHostIsUnknown) {
  const std::string label(64, 'x');  // one more than a label of a host name can have
  expect_problem(open_tcp_stream(label + ":4000"), ErrorCode::kNotFound, "no such host");
}

TEST(TcpStream, SaysThatAHostDoesNotAnswer) {
  const Listener listener{0};
  std::vector<Descriptor> waiting;  // they fill the listener's queue; the kernel ignores the next
  Result<Descriptor> next = fail(ErrorCode::kSystem);
  const TcpAddress address{"127.0.0.1", std::to_string(listener.port())};
  while ((next = connect_tcp(address, 200ms))) waiting.push_back(std::move(*next));
  EXPECT_EQ(next.error().code, ErrorCode::kTimedOut);
}

TEST(TcpStream, RefusesAddressesThatAreNone) {
  for (const auto* const text : {"", ":", "host", "host:", ":4000", "host:0", "host:65536",
                                 "host:4000x", "::1:4000", "[::1:4000", "[]:4000"}) {
    expect_problem(open_tcp_stream(text), ErrorCode::kBadTarget, "tcp:HOST:PORT");
  }
}

TEST(TcpStream, ReadsIpv6AddressesInBrackets) {
  const auto address = parse_tcp_address("[::1]:4000");
  ASSERT_TRUE(address);
  EXPECT_EQ(address->host, "::1");
  EXPECT_EQ(address->port, "4000");
}

}  // namespace
}  // namespace armjig
