// SPDX-License-Identifier: Apache-2.0
// What people can do at a hosted KinovaZED server and its arm.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "emulators/kinovazed/arm_port.hpp"
#include "emulators/kinovazed/options.hpp"

namespace armjig::kinovazed::host {
namespace {

using namespace emulation;
using namespace std::chrono_literals;

DefectiveServer running_server(const DeviceOptions& options = {}) {
  auto server = *make(options, "test");
  server.advance_to(at(1s));
  return server;
}

/// The x of the arm, as the server writes it to its log.
double logged_x(DefectiveServer& server, Instant time, ConnectionId client) {
  constexpr std::string_view kLine = "GetAbsolutePosition\r\n";
  server.clear_log();
  server.receive(time, client, std::as_bytes(std::span{kLine}));
  server.advance_to(time + 200ms);
  const auto text = server.log().back().text;
  constexpr std::string_view kX = "\"X\": ";
  return std::stod(text.substr(text.find(kX) + kX.size()));
}

TEST(KinovazedInputs, AreAllKnown) {
  auto server = running_server();
  for (const auto& input : server_inputs()) {
    constexpr std::string_view kCall = "CALL";
    std::string name{input.name};
    if (!name.ends_with(kCall)) {
      EXPECT_TRUE(server.set_input(at(1s), name, 0)) << name;
      continue;
    }
    name.resize(name.size() - kCall.size());
    for (const auto call : kArmCallNames) {
      EXPECT_TRUE(server.set_input(at(1s), name + std::string{call}, 0)) << call;
    }
  }
}

TEST(KinovazedInputs, AreNoOthers) {
  auto server = running_server();
  for (const auto* name : {"", "arm", "arm.fail.", "arm.fail.CALL", "arm.joystick.", "arm.foot",
                           "arm.at.", "arm.at.w"}) {
    EXPECT_FALSE(server.set_input(at(1s), name, 0)) << name;
  }
}

TEST(KinovazedInputs, MoveTheArmByItsOwnJoystickUntilItIsLetGo) {
  auto server = running_server();
  const auto client = *server.connect(at(1s));
  const auto before = logged_x(server, at(1s), client);
  ASSERT_TRUE(server.set_input(at(2s), "arm.joystick.x", 1000));
  const auto moved = logged_x(server, at(3s), client);
  EXPECT_NEAR(std::abs(moved - before), 0.2, 0.05) << "20 cm in a second, at full deflection";
  ASSERT_TRUE(server.set_input(at(3200ms), "arm.joystick.x", 0));
  const auto let_go = logged_x(server, at(4s), client);
  EXPECT_NEAR(logged_x(server, at(6s), client), let_go, 0.001);
}

TEST(KinovazedInputs, PutTheHandSomewhereAndHoldItThere) {
  for (const auto* plant : {"jaco", "bench"}) {
    auto server = running_server({{"plant", plant}});
    const auto client = *server.connect(at(1s));
    ASSERT_TRUE(server.set_input(at(1s), "arm.held", 1));
    constexpr std::string_view kLead = "QuitEStop\r\nInitialize\r\n";
    server.receive(at(1s), client, std::as_bytes(std::span{kLead}));
    ASSERT_TRUE(server.set_input(at(2s), "arm.at.x", -123'456));
    EXPECT_NEAR(logged_x(server, at(12s), client), -0.123456, 0.001) << plant << ", led by nobody";
    ASSERT_TRUE(server.set_input(at(13s), "arm.held", 0));
    EXPECT_GT(logged_x(server, at(23s), client), 0.1) << plant << ", at its ready pose";
  }
}

TEST(KinovazedInputs, HaveNoJoystickOnTheArmOfTheRecordings) {
  auto server = running_server({{"plant", "bench"}});
  EXPECT_FALSE(server.set_input(at(1s), "arm.joystick.x", 1000));
}

}  // namespace
}  // namespace armjig::kinovazed::host
