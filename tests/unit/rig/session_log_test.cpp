// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/logged_ports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/capture/trace.hpp"
#include "harness/rig/rig.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

class SessionLogTest : public testing::Test {
 protected:
  ~SessionLogTest() override { fs::remove(path_); }

  [[nodiscard]] Rig<SessionSource> logged_server() const {
    RigOptions options;
    options.target = parse_target("emulated:").value();
    options.capture.file = OutputFile::open(path_, OutputFile::Kind::kGrowing).value();
    return *cli::open_rig<cli::OnServer>(test::device("kinovazed"), options);
  }
  [[nodiscard]] std::vector<TraceEvent> events() const { return read_trace(path_).value().events; }
  /// Direction, connection and text of each line.
  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> all;
    for (const auto& event : events()) {
      const auto json = nlohmann::json::parse(event.json);
      all.push_back(event.dir + " " + std::to_string(event.id) + " " + json.value("text", ""));
    }
    return all;
  }

  std::string path_ =
      fs::temp_directory_path() / ("armjig-session-log-" + std::to_string(::getpid()));
};

void say(SessionPort& port, std::string_view line) {
  ASSERT_TRUE(port.send(std::as_bytes(std::span{line})));
}

void hear(SessionPort& port) {
  std::array<std::byte, 256> buffer;
  ASSERT_TRUE(port.receive(buffer, port.now() + 500ms));
}

TEST_F(SessionLogTest, NumbersTheConnectionsOfOneServer) {
  {
    auto server = logged_server();
    const auto one = server.port().make_port();
    const auto two = server.port().make_port();
    ASSERT_TRUE(one->connect(one->now()));
    ASSERT_TRUE(two->connect(two->now()));
    say(*one, "QuitEStop\r\n");
    hear(*one);
    two->reset();
    one->half_close();
    one->close();
    ASSERT_TRUE(two->connect(two->now()));
  }
  EXPECT_THAT(lines(),
              testing::ElementsAre("connect 0 ok", "connect 1 ok", "to_device 0 ", "from_device 0 ",
                                   "disconnect 1 client-reset", "disconnect 0 client-half-close",
                                   "disconnect 0 client-close", "connect 2 ok",
                                   "disconnect 2 client-close"));
}

TEST_F(SessionLogTest, SaysWhatWasMeant) {
  auto server = logged_server();
  const auto port = server.port().make_port();
  ASSERT_TRUE(port->connect(port->now()));
  say(*port, "Quit");
  say(*port, "EStop\r\n");
  const auto all = events();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_FALSE(nlohmann::json::parse(all[1].json).contains("messages"));
  EXPECT_EQ(nlohmann::json::parse(all[2].json)["messages"].size(), 1U);
}

TEST_F(SessionLogTest, HasWhatAHandDoes) {
  auto server = logged_server();
  ASSERT_TRUE(server.port().touch("arm.plugged", 0));
  ASSERT_FALSE(server.port().touch("arm.foot", 0));
  const auto all = events();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].dir, "input");
  EXPECT_EQ(all[0].name, "arm.plugged");
}

TEST_F(SessionLogTest, HasWhatPassesOnAConnectionThatIsUsedAsAStream) {
  RigOptions options;
  options.target = parse_target("emulated:").value();
  options.capture.file = OutputFile::open(path_, OutputFile::Kind::kGrowing).value();
  options.impairment = parse_impairment("out.delay=1ms").value();
  {
    auto server = cli::open_rig<cli::OnServer>(test::device("kinovazed"), options).value();
    auto rig = connect(std::move(server), "emulated:").value();
    constexpr std::string_view kLine = "QuitEStop\r\n";
    ASSERT_TRUE(rig.port().write(std::as_bytes(std::span{kLine})));
    std::array<std::byte, 256> buffer;
    EXPECT_GT(rig.port().read(buffer, rig.port().now() + 500ms).value(), 0U);
    EXPECT_FALSE(rig.last_refusal());
    EXPECT_EQ(rig.impairments()->out.bytes_out, kLine.size());
  }
  EXPECT_THAT(lines(), testing::ElementsAre("connect 0 ok", "to_device 0 ", "from_device 0 ",
                                            "disconnect 0 client-close"));
}

TEST_F(SessionLogTest, AServerWhereNobodyListensCannotBeAStream) {
  RigOptions options;
  options.target = parse_target("tcp:127.0.0.1:1").value();
  auto server = cli::open_rig<cli::OnServer>(test::device("kinovazed"), options).value();
  const auto rig = connect(std::move(server), "tcp:127.0.0.1:1");
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().code, ErrorCode::kRefused);
  EXPECT_EQ(rig.error().where, "tcp:127.0.0.1:1");
}

/// A port whose clock stands.
class PortAt final : public SessionPort {
 public:
  explicit PortAt(Instant time) : time_{time} {}
  Result<void> connect(Instant /*deadline*/) override { return {}; }
  Result<void> send(Bytes /*segment*/) override { return {}; }
  Result<Received> receive(std::span<std::byte> /*into*/, Instant /*deadline*/) override {
    return Received{Arrival::kEnd, 0};
  }
  void half_close() override {}
  void close() override {}
  void reset() override {}
  [[nodiscard]] Instant now() const override { return time_; }

 private:
  Instant time_;
};

TEST_F(SessionLogTest, NeverRunsBackwards) {
  const auto log =
      WireLog::create({.file = OutputFile::open(path_, OutputFile::Kind::kGrowing).value()},
                      {.device = "kinovazed", .make_dissector = kinovazed::make_dissector})
          .value();
  const auto late = put_log_on(std::make_unique<PortAt>(at(501ms)), log);
  const auto early = put_log_on(std::make_unique<PortAt>(at(1ms)), log);
  ASSERT_TRUE(late->connect({}));
  ASSERT_TRUE(early->connect({}));
  const auto all = events();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].time, at(501ms));
  EXPECT_EQ(all[1].time, at(501ms));
}

}  // namespace
}  // namespace armjig
