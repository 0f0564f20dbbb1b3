// SPDX-License-Identifier: Apache-2.0
#include "emulators/shadow/shadow.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "emulators/memory/in_memory.hpp"
#include "emulators/memory/overheard.hpp"
#include "harness/link/session_port.hpp"
#include "harness/wire/demo/demo.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/morap/dissector.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// What is told of two devices.
class ToldOfBoth {
 public:
  ToldOfBoth(AnyHosted twin, MakeDissector make_dissector, ComparisonRules rules = {})
      : shadow{std::move(twin), make_dissector, std::move(rules),
               Shadow::Listener{
                   [this](const Divergence& divergence) { lines.push_back(describe(divergence)); },
                   [this](Instant, const std::string&, std::size_t after) {
                     lines.push_back("again after " + std::to_string(after));
                   }}} {}

  std::vector<std::string> lines;
  Shadow shadow;
};

template <class Kind>
auto made(std::string_view name, const DeviceOptions& options = {}) {
  return cli::emulate(std::get<Kind>(test::device(name).port), options, "test").value();
}

/// Starts, halts and queries, on a demo device with these options beside one without.
std::vector<std::string> told_of_demo(const DeviceOptions& options, ComparisonRules rules = {}) {
  ToldOfBoth told{made<cli::OnStream>("demo"), demo::make_dissector, std::move(rules)};
  const auto port = open_in_memory(overhear(made<cli::OnStream>("demo", options), told.shadow));
  std::array<std::byte, 64> buffer;
  using enum demo::Operation;
  for (const auto operation : {kStart, kQuery, kHalt, kQuery, kStart, kQuery}) {
    EXPECT_TRUE(port->write(demo::encode(operation)));
    while (port->read(buffer, port->now() + 50ms).value_or(0) > 0) {
    }
  }
  told.shadow.finish();
  return told.lines;
}

TEST(Shadow, SaysNothingOfADeviceLikeItsTwin) { EXPECT_THAT(told_of_demo({}), IsEmpty()); }

TEST(Shadow, TellsTheFirstMessageThatDiffersWithWhatEachSideSays) {
  ToldOfBoth told{made<cli::OnStream>("demo"), demo::make_dissector};
  for (const auto begin : {10ms, 20ms}) {
    told.shadow.to_device(at(begin), demo::encode(demo::Operation::kQuery));
    told.shadow.from_device(at(begin + 1ms), demo::encode(demo::State::kHalted));
  }
  told.shadow.wait_until(at(30ms));
  ASSERT_EQ(told.lines.size(), 2U) << "followed on";
  EXPECT_THAT(told.lines.front(),
              HasSubstr("0.011000 s: 'reply' differs (device, emulated): state: "));
}

TEST(Shadow, TellsOfTimesUnlessTheRulesAllowThem) {
  EXPECT_THAT(told_of_demo({{"clock", "-5"}}), testing::Each(HasSubstr("time: ")));
  EXPECT_THAT(told_of_demo({{"clock", "-5"}}, {.time_tolerance = 1ms}), IsEmpty());
}

TEST(Shadow, AgreesAgainAfterAMessageOfTheTwinAlone) {
  ToldOfBoth told{made<cli::OnStream>("demo"), demo::make_dissector};
  const auto say = [&](Duration time, demo::State state) {
    told.shadow.from_device(at(time), demo::encode(state));
  };
  told.shadow.to_device(at(0ms), demo::encode(demo::Operation::kQuery));
  told.shadow.to_device(at(10ms), demo::encode(demo::Operation::kQuery));
  say(11ms, demo::State::kReady);  // the first one was not answered
  told.shadow.wait_until(at(20ms));
  told.shadow.to_device(at(30ms), demo::encode(demo::Operation::kQuery));
  say(31ms, demo::State::kReady);
  say(32ms, demo::State::kReady);
  told.shadow.wait_until(at(50ms));
  EXPECT_THAT(told.lines, ElementsAre(HasSubstr("comes from the emulated one only"),
                                      "again after 1", HasSubstr("comes from the device only")));
  EXPECT_EQ(told.shadow.counts().messages, 3U);
  EXPECT_EQ(told.shadow.counts().divergences, 2U);
}

/// What is told of a server whose calls to its arm take less time than the twin's, under a host
/// that sends its next line as soon as it is told of the end of the one before.
std::vector<std::string> told_of_a_quick_host(Duration tolerance) {
  ToldOfBoth told{made<cli::OnServer>("kinovazed", {{"call-us", "4000"}}),
                  kinovazed::make_dissector,
                  {.time_tolerance = tolerance, .ignored_messages = {"Heartbeat"}}};
  const auto server =
      open_in_memory(overhear(made<cli::OnServer>("kinovazed", {{"call-us", "100"}}), told.shadow));
  const auto port = server->make_port();
  EXPECT_TRUE(port->connect(port->now() + 1s));
  struct Exchange {
    std::string_view line;
    std::string_view end;
  };
  for (const auto& [line, end] :
       {Exchange{"QuitEStop\r\n", "Accepted"}, Exchange{"Initialize\r\n", "Initialized"},
        Exchange{"Freeze\r\n", "Freezed"}, Exchange{"Unfreeze\r\n", "Unfreezed"}}) {
    EXPECT_TRUE(port->send(std::as_bytes(std::span{line})));
    std::string heard;
    const auto latest = port->now() + 30s;
    while (heard.find(end) == std::string::npos && port->now() < latest) {
      std::array<std::byte, 256> buffer;
      const auto size = port->receive(buffer, latest).value().size;
      heard.append(reinterpret_cast<const char*>(buffer.data()), size);
    }
    EXPECT_THAT(heard, HasSubstr(end)) << line;
  }
  told.shadow.finish();
  return told.lines;
}

TEST(Shadow, LetsTheTwinSayFirstWhatTheHostActsOn) {
  EXPECT_THAT(told_of_a_quick_host(100ms), IsEmpty());
  EXPECT_THAT(told_of_a_quick_host(1ms), testing::Not(IsEmpty())) << "that is too late";
}

TEST(Shadow, DoesNotMissWhatTheRulesIgnore) {
  ToldOfBoth told{made<cli::OnServer>("kinovazed"),
                  kinovazed::make_dissector,
                  {.ignored_messages = {"Heartbeat"}}};
  told.shadow.on_connection({.time = at(1s), .kind = ConnectionEvent::Kind::kBegun});
  told.shadow.wait_until(at(5s));  // the twin beats each second, and the device never does
  told.shadow.finish();
  EXPECT_THAT(told.lines, IsEmpty());
  EXPECT_EQ(told.shadow.counts().messages, 0U) << "nothing was judged";
}

TEST(Shadow, FollowsConnectionsOfAServer) {
  for (const bool is_faulty : {false, true}) {
    ToldOfBoth told{made<cli::OnServer>("kinovazed"), kinovazed::make_dissector};
    const DeviceOptions options = is_faulty ? DeviceOptions{{"call-us", "5000"}} : DeviceOptions{};
    const auto server =
        open_in_memory(overhear(made<cli::OnServer>("kinovazed", options), told.shadow));
    const auto port = server->make_port();
    ASSERT_TRUE(port->connect(port->now() + 1s));
    constexpr std::string_view kLine = "QuitEStop\r\n";
    ASSERT_TRUE(port->send(std::as_bytes(std::span{kLine})));
    std::array<std::byte, 256> buffer;
    while (port->receive(buffer, port->now() + 1500ms)->arrival == SessionPort::Arrival::kData) {
      if (port->now() > at(4s)) break;
    }
    EXPECT_GT(told.shadow.counts().messages, 2U);
    EXPECT_EQ(told.lines.empty(), !is_faulty) << told.lines.front();
  }
}

TEST(Shadow, ReadsWhatTheMasterReadsOnABus) {
  for (const bool is_faulty : {false, true}) {
    ToldOfBoth told{made<cli::OnBus>("morap"), morap::make_dissector};
    const DeviceOptions options = is_faulty ? DeviceOptions{{"nodes", "3"}} : DeviceOptions{};
    const auto port = open_in_memory(overhear(made<cli::OnBus>("morap", options), told.shadow));
    constexpr std::array kVoltage{std::byte{0x01}, std::byte{0}, std::byte{0}, std::byte{0x40},
                                  std::byte{0x40}};
    const BusAddress node{0x12};
    for (int i = 0; i < 5; ++i) {
      std::array<std::byte, 4> read{};
      const std::array writes{write_to(node, kVoltage)};
      const std::array reads{read_from(node, read)};
      (void)port->transfer(writes);
      (void)port->transfer(reads);
      port->wait_until(port->now() + 100ms);
    }
    told.shadow.finish();
    EXPECT_GT(told.shadow.counts().messages, 4U);
    EXPECT_EQ(told.lines.empty(), !is_faulty);
  }
}

}  // namespace
}  // namespace armjig
