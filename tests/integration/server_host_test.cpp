// SPDX-License-Identifier: Apache-2.0
// Servers on real TCP, in this process: who comes, goes and throws connections away.
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "emulators/demo/demo.hpp"
#include "emulators/host/host.hpp"
#include "emulators/kinovazed/server.hpp"
#include "harness/link/descriptor.hpp"
#include "harness/link/tcp_session.hpp"
#include "tests/integration/support/program.hpp"
#include "tests/integration/support/sockets.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using Arrival = SessionPort::Arrival;

/// A server on its own thread, and what it says in its log.
class RunningServer {
 public:
  explicit RunningServer(std::unique_ptr<HostedServer> server)
      : host_{Host::open(std::move(server), {.tcp = TcpOptions{},
                                             .log =
                                                 [this](auto line) {
                                                   const std::lock_guard lock{guard_};
                                                   log_.emplace_back(line);
                                                 }})
                  .value()},
        thread_{[this] { host_.run(); }} {}
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;
  ~RunningServer() { (void)stop(); }

  HostStatistics stop() {
    host_.stop();
    if (thread_.joinable()) thread_.join();
    return host_.statistics();
  }
  [[nodiscard]] std::unique_ptr<SessionPort> client() const {
    return make_tcp_session(host_.targets().front().substr(4)).value();
  }
  [[nodiscard]] std::uint16_t port() const {
    const auto target = host_.targets().front();
    return static_cast<std::uint16_t>(std::stoi(target.substr(target.rfind(':') + 1)));
  }
  [[nodiscard]] auto lines_with(std::string_view words) {
    const std::lock_guard lock{guard_};
    return std::ranges::count_if(
        log_, [words](const std::string& line) { return line.find(words) != std::string::npos; });
  }

 private:
  std::mutex guard_;
  std::vector<std::string> log_;
  Host host_;
  std::thread thread_;
};

/// As documented, because the shipped server may die of a client that goes.
std::unique_ptr<HostedServer> kinovazed_server() {
  using namespace kinovazed::emulation;
  ServerOptions options;
  options.behaviour = kDocumentedBehaviour;
  return make_hosted(Server{ArmPort{BenchArm{}}, options});
}

::testing::AssertionResult connect(SessionPort& client) {
  const auto connected = client.connect(client.now() + testing::kPatience);
  if (connected) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << describe(connected.error().code);
}

Arrival next(SessionPort& client) {
  std::array<std::byte, 512> buffer;
  const auto received = client.receive(buffer, client.now() + testing::kPatience);
  return received ? received->arrival : Arrival::kDeadline;
}

std::size_t open_files() {
  const std::filesystem::directory_iterator files{"/proc/self/fd"};
  return static_cast<std::size_t>(std::distance(files, {}));
}

TEST(ServerHost, GreetsAClientOfADeviceThatTakesOne) {
  RunningServer server{make_hosted(demo::emulation::SessionDevice{})};
  const auto client = server.client();
  ASSERT_TRUE(connect(*client));
  EXPECT_EQ(next(*client), Arrival::kData);
  const auto second = server.client();
  ASSERT_TRUE(connect(*second)) << "by the kernel";
  EXPECT_NE(next(*second), Arrival::kData);
  client->half_close();
  EXPECT_EQ(next(*client), Arrival::kEnd);
  EXPECT_EQ(server.stop().links.refused, 1U);
}

TEST(ServerHost, KeepsNoDescriptorOfClientsThatReset) {
  constexpr int kClients = 3000;
  RunningServer server{kinovazed_server()};
  const auto client = server.client();
  ASSERT_TRUE(connect(*client));
  EXPECT_EQ(next(*client), Arrival::kData);
  client->close();
  const auto before = open_files();
  std::size_t most = 0;
  for (int i = 0; i < kClients; ++i) {
    ASSERT_TRUE(connect(*client)) << i;
    if (i % 3 == 0) (void)client->send(std::as_bytes(std::span{"EStop\r\n", 7}));
    if (i % 7 == 0) client->half_close();
    client->reset();
    if (i % 100 == 0) most = std::max(most, open_files());
  }
  // Those of the last clients, who may still be on their way.
  EXPECT_LE(most, before + 20);
  ASSERT_TRUE(connect(*client));
  EXPECT_EQ(next(*client), Arrival::kData) << "it serves the next one";
  EXPECT_LE(open_files(), before + 2);
  client->close();
  EXPECT_EQ(server.stop().links.clients, kClients + 2U);
}

/// Leaves no descriptor to this process while it lives.
class NoDescriptorLeft {
 public:
  NoDescriptorLeft() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    auto few = before_;
    few.rlim_cur = 256;
    ::setrlimit(RLIMIT_NOFILE, &few);
    for (int fd = ::dup(0); fd >= 0; fd = ::dup(0)) taken_.push_back(fd);
  }
  NoDescriptorLeft(const NoDescriptorLeft&) = delete;
  NoDescriptorLeft& operator=(const NoDescriptorLeft&) = delete;
  ~NoDescriptorLeft() {
    for (const auto fd : taken_) ::close(fd);
    ::setrlimit(RLIMIT_NOFILE, &before_);
  }

 private:
  rlimit before_{};
  std::vector<int> taken_;
};

TEST(ServerHost, SaysOnceThatItCannotTakeClientsAndTakesThemLater) {
  RunningServer server{kinovazed_server()};
  const Descriptor client{::socket(AF_INET, SOCK_STREAM, 0)};
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(server.port());
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  {
    const NoDescriptorLeft none;
    ASSERT_EQ(::connect(client.value(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
    const Stopwatch clock;
    while (server.lines_with("cannot take clients") == 0 && clock.now() < at(testing::kPatience)) {
      std::this_thread::yield();
    }
    std::this_thread::sleep_for(300ms);  // some more tries
    EXPECT_EQ(server.lines_with("cannot take clients"), 1);
  }
  EXPECT_EQ(testing::receive_plain(client, 1).size(), 1U) << "a beat";
}

}  // namespace
}  // namespace armjig
