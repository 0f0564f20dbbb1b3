// SPDX-License-Identifier: Apache-2.0
// `armjig console` and `armjig watch` from outside: on a terminal, and on real links.
#include <gmock/gmock.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/link/descriptor.hpp"
#include "tests/integration/support/program.hpp"

namespace armjig {
namespace {

using ::testing::HasSubstr;
using testing::Program;
using testing::run_armjig;
namespace fs = std::filesystem;

fs::path scratch(const std::string& name) {
  return fs::temp_directory_path() / ("armjig-console-" + std::to_string(::getpid()) + "-" + name);
}

/// The program on a terminal of its own, with somebody who types and reads.
class Terminal {
 public:
  explicit Terminal(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), ARMJIG_PROGRAM);
    const auto state = scratch("state");  // named by this process, not by the child
    int master = -1;
    winsize size{.ws_row = 40, .ws_col = 100, .ws_xpixel = 0, .ws_ypixel = 0};
    pid_ = ::forkpty(&master, nullptr, nullptr, &size);
    if (pid_ == 0) {
      ::setenv("TERM", "xterm", 1);
      ::setenv("XDG_STATE_HOME", state.c_str(), 1);
      std::vector<char*> words;
      for (auto& argument : arguments) words.push_back(argument.data());
      words.push_back(nullptr);
      ::execv(ARMJIG_PROGRAM, words.data());
      ::_exit(127);
    }
    master_ = Descriptor{master};
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
  }

  void type(std::string_view keys) const {
    ASSERT_EQ(::write(master_.value(), keys.data(), keys.size()),
              static_cast<ssize_t>(keys.size()));
  }

  /// Reads until the words come, and forgets what was in front of them.
  void expect(const std::string& words) {
    while (shown_.find(words) == std::string::npos) {
      ASSERT_TRUE(read_more()) << "no '" << words << "' in:\n" << shown_;
    }
    shown_.erase(0, shown_.find(words) + words.size());
  }

  int wait() {
    while (read_more()) {
    }
    if (!has_ended()) ::kill(pid_, SIGKILL);
    int status = 0;
    ::waitpid(std::exchange(pid_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  bool read_more() {
    pollfd ready{.fd = master_.value(), .events = POLLIN, .revents = 0};
    const auto patience = std::chrono::milliseconds{testing::kPatience}.count();
    if (::poll(&ready, 1, static_cast<int>(patience)) != 1) return false;
    std::array<char, 4096> buffer;
    const auto size = ::read(master_.value(), buffer.data(), buffer.size());
    if (size > 0) shown_.append(buffer.data(), static_cast<std::size_t>(size));
    return size > 0;
  }

  /// Nobody has the terminal open any more.
  bool has_ended() const {
    pollfd ready{.fd = master_.value(), .events = 0, .revents = 0};
    return ::poll(&ready, 1, 0) == 1 && (ready.revents & POLLHUP) != 0;
  }

  pid_t pid_ = -1;
  Descriptor master_;
  std::string shown_;
};

/// An emulated board on a pseudo-terminal.
class EmulatedBoard {
 public:
  EmulatedBoard() { (void)program_.read_line(); }
  EmulatedBoard(const EmulatedBoard&) = delete;
  EmulatedBoard& operator=(const EmulatedBoard&) = delete;
  ~EmulatedBoard() {
    program_.signal(SIGTERM);
    (void)program_.wait();
  }
  std::string target() const { return "pty:" + link_; }

 private:
  std::string link_ = scratch("board").string();
  Program program_{{"emulate", "parol6", "--link", link_}};
};

class Console : public ::testing::Test {
 protected:
  ~Console() override { fs::remove_all(scratch("state")); }
};

TEST_F(Console, CompletesRemembersAndLeavesOnATerminal) {
  {
    Terminal terminal{{"console", "parol6", "--target", "emulated:"}};
    terminal.expect("parol6> ");
    terminal.type("sta");
    terminal.type("\t");
    terminal.expect("t");
    terminal.type("\t");
    terminal.expect("status stats");
    terminal.type("us\n");
    terminal.expect("estop      released");
    terminal.type("quit\n");
    EXPECT_EQ(terminal.wait(), 0);
  }
  Terminal terminal{{"console", "parol6", "--target", "emulated:"}};
  terminal.expect("parol6> ");
  terminal.type("\033[A\033[A\n");  // up, up
  terminal.expect("estop      released");
  terminal.expect("parol6> ");  // before, the terminal itself would take Ctrl-D
  terminal.type("\x04");
  EXPECT_EQ(terminal.wait(), 0);
}

TEST_F(Console, TakesCommandsWhileOneGoesOn) {
  Terminal terminal{{"console", "parol6", "--target", "emulated:"}};
  terminal.expect("parol6> ");
  terminal.type("home\n");
  terminal.expect("[home");
  terminal.type("jog j1 100\n");
  terminal.expect("home is still going on");
  terminal.type("stop\n");
  terminal.expect("stopped; the board is disabled");
  terminal.type("enable\n");
  terminal.expect("enabled");
  terminal.type("jog j1 100\n");
  terminal.expect("[jog]");
  terminal.type("\x03");  // Ctrl-C
  terminal.expect("stopped");
  terminal.type("quit\n");
  EXPECT_EQ(terminal.wait(), 0);
}

TEST_F(Console, SaysWhatMayNotBeDoneToARealBoard) {
  const EmulatedBoard board;
  Terminal terminal{{"console", "parol6", "--target", board.target(), "--allow", "state,move"}};
  terminal.expect("parol6> ");
  terminal.type("home\n");
  terminal.expect("refused: home needs --allow home");
  terminal.type("jog j1 9000\n");
  terminal.expect("refused: j1 may jog at most at 1500 steps/s");
  terminal.type("goto j1=100\n");
  terminal.expect("refused: go-to needs a homed arm");
  terminal.type("jog j1 300 0.1\n");
  terminal.expect("moved +");
  terminal.type("quit\n");
  EXPECT_EQ(terminal.wait(), 0);
}

TEST_F(Console, SaysThatTheBoardIsGone) {
  auto board = std::make_unique<EmulatedBoard>();
  Terminal terminal{{"console", "parol6", "--target", board->target()}};
  terminal.expect("parol6> ");
  board.reset();
  terminal.expect("is it still there");
  EXPECT_EQ(terminal.wait(), 3);
}

TEST(Watch, ShowsAPageOnATerminalAndPutsItBack) {
  const EmulatedBoard board;
  Terminal terminal{{"watch", "parol6", "--target", board.target()}};
  terminal.expect("\033[?1049h");
  terminal.expect("estop      released");
  terminal.expect("round trip");
  terminal.type("q");
  terminal.expect("\033[?1049l");
  terminal.expect("0 bad");
  EXPECT_EQ(terminal.wait(), 0);
}

TEST(Watch, EndsWellOnASignal) {
  const EmulatedBoard board;
  for (const int signal : {SIGINT, SIGTERM}) {
    Program program{{"watch", "parol6", "--target", board.target()}};
    EXPECT_THAT(program.read_line(), HasSubstr("estop released"));
    program.signal(signal);
    EXPECT_EQ(program.wait(), 0);
  }
}

TEST(Watch, GoesOnWhenTheBoardIsBack) {
  auto board = std::make_unique<EmulatedBoard>();
  Program program{{"watch", "parol6", "--target", board->target(), "--reconnect", "--json"}};
  EXPECT_THAT(program.read_line(), HasSubstr("armjig.telemetry/1"));
  board.reset();
  board = std::make_unique<EmulatedBoard>();
  std::string line = program.read_line();
  while (line.find("\"lost\":0") != std::string::npos) line = program.read_line();
  EXPECT_THAT(line, HasSubstr("armjig.telemetry/1")) << "after some frames had no answer";
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 0);
}

TEST(Watch, SaysThatNobodyAnswers) {
  int master = -1;
  int slave = -1;
  std::array<char, 256> name{};
  ASSERT_EQ(::openpty(&master, &slave, name.data(), nullptr, nullptr), 0);
  const Descriptor ends[] = {Descriptor{master}, Descriptor{slave}};
  const auto ended = run_armjig(
      {"watch", "parol6", "--target", std::string{"pty:"} + name.data(), "--count", "5"});
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_THAT(ended.errors, HasSubstr("no telemetry came"));
}

TEST(Watch, RefusesWhatItCannotDoInOneLine) {
  const auto expect = [](std::vector<std::string> arguments, const std::string& words) {
    arguments.insert(arguments.begin(), "watch");
    const auto ended = run_armjig(arguments);
    EXPECT_EQ(ended.exit_code, 2) << ended.errors;
    EXPECT_THAT(ended.errors, HasSubstr(words));
  };
  expect({"parol6"}, "--target");
  expect({"parol6", "--target", "emulated:"}, "--seconds");
  expect({"parol6", "--target", "emulated:", "--rate", "0"}, "rate");
  expect({"parol6", "--target", "emulated:", "--count", "0"}, "count");
  expect({"parol6", "--target", "emulated:", "--count", "1", "--seconds", "1"}, "excludes");
  expect({"parol6", "--target", "emulated:", "--seconds", "never"}, "seconds");
  expect({"parol6", "--target", "pty:/dev/null", "--reconnect", "--allow", "move"}, "by a person");
}

}  // namespace
}  // namespace armjig
