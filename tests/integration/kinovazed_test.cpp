// SPDX-License-Identifier: Apache-2.0
// The emulated KinovaZED server as its clients see it: over TCP, in a process of its own.
#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "harness/link/tcp_session.hpp"
#include "tests/integration/support/program.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::Program;
using testing::run_armjig;
using ::testing::StartsWith;
namespace fs = std::filesystem;

/// A real TCP client.
class Client {
 public:
  explicit Client(const std::string& listening) {
    constexpr std::string_view kPrefix = "listening tcp:";
    EXPECT_THAT(listening, StartsWith(std::string{kPrefix}));
    session_ = *make_tcp_session(listening.substr(kPrefix.size()));
    EXPECT_TRUE(session_->connect(session_->now() + testing::kPatience));
  }

  void send(std::string_view text) { EXPECT_TRUE(session_->send(std::as_bytes(std::span{text}))); }

  /// Reads up to that many lines without beats; `<end>` is one.
  std::string hear(int lines) {
    std::string heard;
    while (lines > 0) {
      const auto line = next_line();
      if (line.starts_with("Heartbeat:")) continue;
      heard += line;
      --lines;
      if (line == "<end>") break;
    }
    return heard;
  }

  /// The next beat.
  std::string beat() {
    for (;;) {
      const auto line = next_line();
      if (line.starts_with("Heartbeat:") || line == "<end>") return line;
    }
  }

  SessionPort& session() { return *session_; }

 private:
  std::string next_line() {
    for (;;) {
      const auto end = text_.find('\n');
      if (end != std::string::npos) {
        auto line = text_.substr(0, end + 1);
        text_.erase(0, end + 1);
        return line;
      }
      std::array<std::byte, 512> buffer;
      const auto received = session_->receive(buffer, session_->now() + testing::kPatience);
      if (!received || received->arrival != SessionPort::Arrival::kData) return "<end>";
      for (std::size_t i = 0; i < received->size; ++i)
        text_.push_back(static_cast<char>(buffer[i]));
    }
  }

  std::unique_ptr<SessionPort> session_;
  std::string text_;
};

std::vector<std::string> emulate(std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"emulate", "kinovazed", "--tcp", "0", "--speed", "20"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(HostedKinova, ServesTheDocumentedStart) {
  Program program{emulate()};
  Client client{program.read_line()};
  client.send("EStop\r\nQuitEStop\r\nInitialize\r\n");
  EXPECT_EQ(client.hear(4), "Accepted\r\nAccepted\r\nAccepted\r\nInitialized\r\n");
  EXPECT_EQ(client.beat(), "Heartbeat:21\r\n");
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
}

TEST(HostedKinova, EndsAHalfClosedConnectionBehindItsAnswer) {
  Program program{emulate()};
  Client client{program.read_line()};
  client.send("EStop\r\n");
  client.session().half_close();
  EXPECT_EQ(client.hear(2), "Accepted\r\n<end>");
}

TEST(HostedKinova, LetsTheSecondClientWaitForTheFirst) {
  Program program{emulate()};
  const auto place = program.read_line();
  Client first{place};
  first.send("QuitEStop\r\n");
  EXPECT_EQ(first.hear(1), "Accepted\r\n");
  Client second{place};
  second.send("EStop\r\n");
  EXPECT_EQ(first.beat(), "Heartbeat:1\r\n") << "nobody has read the second client's line";
  first.session().reset();
  EXPECT_EQ(second.hear(1), "Accepted\r\n");
}

TEST(HostedKinova, RefusesConnectionsWhenDeadAndComesBack) {
  const auto file = fs::temp_directory_path() / ("armjig-objectives-" + std::to_string(::getpid()));
  std::ofstream{file} << "[]";
  Program program{emulate({"--set", "objectives=" + file.string(), "--set", "on-death=restart"})};
  const auto place = program.read_line();
  Client client{place};
  client.send("RunObjective:Home\r\n");
  EXPECT_EQ(client.hear(1), "<end>");
  const auto session = *make_tcp_session(place.substr(sizeof "listening tcp:" - 1));
  const auto deadline = session->now() + testing::kPatience;
  while (!session->connect(session->now() + 1s) && session->now() < deadline) {
  }
  EXPECT_LT(session->now(), deadline);
  fs::remove(file);
}

TEST(HostedKinova, SaysInOneLineWhatIsWrongWithItsOptions) {
  const auto ended = run_armjig(emulate({"--set", "profile=best"}));
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("write firmware or documented"));
  EXPECT_EQ(run_armjig(emulate({"--set", "objectives=/nowhere"})).exit_code, 2);
  EXPECT_EQ(run_armjig({"emulate", "kinovazed", "--pty"}).exit_code, 2);
}

}  // namespace
}  // namespace armjig
