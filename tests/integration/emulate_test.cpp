// SPDX-License-Identifier: Apache-2.0
// The program `armjig emulate` from outside.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "harness/link/real_streams.hpp"
#include "tests/integration/support/program.hpp"
#include "tests/integration/support/sockets.hpp"

namespace armjig {
namespace {

using ::testing::HasSubstr;
using testing::Program;
using testing::run_armjig;
using ::testing::StartsWith;
namespace fs = std::filesystem;

constexpr std::array kQuery{std::byte{0xA5}, std::byte{'q'}, std::byte{0xFF ^ 'q'}};

void expect_answer(StreamPort& port) {
  ASSERT_TRUE(port.write(kQuery));
  std::array<std::byte, 3> answer;
  const auto size = port.read(answer, port.now() + testing::kPatience);
  ASSERT_TRUE(size);
  EXPECT_EQ(*size, 3U);
}

std::string link_path() {
  return (fs::temp_directory_path() / ("armjig-emulate-" + std::to_string(::getpid()))).string();
}

TEST(Emulate, ListensOnAPseudoTerminalByDefault) {
  Program program{{"emulate", "demo"}};
  const auto line = program.read_line();
  ASSERT_THAT(line, StartsWith("listening pty:/dev/"));
  const auto port = open_pty(line.substr(sizeof "listening pty:" - 1));
  ASSERT_TRUE(port) << describe(port.error());
  expect_answer(**port);
}

TEST(Emulate, ListensWhereItSays) {
  Program program{{"emulate", "demo", "--tcp", "0", "--link", link_path()}};
  EXPECT_THAT(program.read_line(), StartsWith("listening pty:/dev/"));
  EXPECT_EQ(program.read_line(), "listening pty:" + link_path() + " (link)");
  const auto line = program.read_line();
  ASSERT_THAT(line, StartsWith("listening tcp:127.0.0.1:"));
  const auto tcp = open_tcp_stream(line.substr(sizeof "listening tcp:" - 1));
  ASSERT_TRUE(tcp) << describe(tcp.error());
  expect_answer(**tcp);
  const auto pty = open_pty(link_path());
  ASSERT_TRUE(pty) << describe(pty.error());
  expect_answer(**pty);
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
}

TEST(Emulate, SaysWhereItListensAsJson) {
  Program program{{"emulate", "demo", "--tcp", "0", "--json"}};
  const auto said = nlohmann::json::parse(program.read_line());
  EXPECT_EQ(said["schema"], "armjig.emulate/1");
  EXPECT_EQ(said["device"], "demo");
  EXPECT_EQ(said["pid"], program.pid());
  ASSERT_EQ(said["listening"].size(), 1U);
  const auto target = said["listening"][0].get<std::string>();
  ASSERT_THAT(target, StartsWith("tcp:"));
  const auto port = open_tcp_stream(target.substr(4));
  ASSERT_TRUE(port);
  expect_answer(**port);
}

class EmulateOnSignal : public ::testing::TestWithParam<int> {};

TEST_P(EmulateOnSignal, EndsWellAndRemovesItsLink) {
  Program program{{"emulate", "demo", "--link", link_path()}};
  (void)program.read_line();
  ASSERT_TRUE(fs::is_symlink(link_path()));
  program.signal(GetParam());
  EXPECT_THAT(program.read_errors(), HasSubstr("0 clients served"));
  EXPECT_EQ(program.wait(), 0);
  EXPECT_FALSE(fs::is_symlink(link_path()));
}
INSTANTIATE_TEST_SUITE_P(Both, EmulateOnSignal, ::testing::Values(SIGINT, SIGTERM));

TEST(Emulate, TakesOverTheLinkOfOneThatWasKilled) {
  {
    Program killed{{"emulate", "demo", "--link", link_path()}};
    (void)killed.read_line();
    killed.signal(SIGKILL);
    EXPECT_EQ(killed.wait(), -SIGKILL);
  }
  ASSERT_TRUE(fs::is_symlink(link_path()));
  // By now the number of its terminal may be somebody else's, whose link would not be taken.
  fs::remove(link_path());
  fs::create_symlink("/dev/pts/99999", link_path());
  Program program{{"emulate", "demo", "--link", link_path()}};
  (void)program.read_line();
  const auto port = open_pty(link_path());
  ASSERT_TRUE(port) << describe(port.error());
  expect_answer(**port);
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
}

/// One line on standard error, and the exit code of DESIGN.md.
void expect_refusal(std::vector<std::string> arguments, int exit_code, const std::string& words) {
  arguments.insert(arguments.begin(), "emulate");
  const auto ended = run_armjig(arguments);
  EXPECT_EQ(ended.exit_code, exit_code) << ended.errors;
  EXPECT_THAT(ended.errors, HasSubstr(words));
  EXPECT_EQ(std::ranges::count(ended.errors, '\n'), 1) << ended.errors;
}

TEST(Emulate, RefusesWrongArgumentsInOneLine) {
  expect_refusal({}, 2, "DEVICE");
  expect_refusal({"toaster"}, 2, "there are: parol6, kinovazed, morap, demo");
  for (const auto* const speed : {"0", "-1", "nan", "inf", "fast"}) {
    expect_refusal({"demo", "--speed", speed}, 2, "speed");
  }
  for (const auto* const port : {"-1", "65536", "x"}) {
    expect_refusal({"demo", "--tcp", port}, 2, "--tcp");
  }
  expect_refusal({"demo", "--bind", "127.0.0.1"}, 2, "--tcp");
  expect_refusal({"demo", "--tcp", "0", "--bind", "here"}, 2, "address");
}

TEST(Emulate, RefusesABusyPortInOneLine) {
  const testing::Listener listener;
  expect_refusal({"demo", "--tcp", std::to_string(listener.port())}, 3, "in use");
}

TEST(Emulate, RefusesAnAddressThatIsNotOurs) {
  // 192.0.2.0/24 is for documentation (RFC 5737).
  expect_refusal({"demo", "--tcp", "0", "--bind", "192.0.2.1"}, 3, "does not have that address");
}

TEST(Emulate, RefusesAForbiddenLinkInOneLine) {
  expect_refusal({"demo", "--link", "/dev/null"}, 2, "/dev/null");
  expect_refusal({"demo", "--link", "/no/such/folder/parol6"}, 3, "folder");
}

}  // namespace
}  // namespace armjig
