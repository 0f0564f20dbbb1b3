// SPDX-License-Identifier: Apache-2.0
// Devices whose type is forgotten, and the ports to them in memory.
#include "emulators/memory/hosted.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "emulators/demo/demo.hpp"
#include "emulators/i2c/thermometer.hpp"
#include "emulators/kinovazed/defects/defective_server.hpp"
#include "emulators/memory/in_memory.hpp"
#include "emulators/parol6/defects/defects.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using kinovazed::emulation::ArmPort;
using kinovazed::emulation::BenchArm;
using kinovazed::emulation::DefectiveServer;
using kinovazed::emulation::Server;
using test::hex;
using ::testing::IsEmpty;
using Arrival = SessionPort::Arrival;

constexpr BusAddress kThermometer{0x48};

/// What comes within a second of virtual time.
Arrival next(SessionPort& port) {
  std::array<std::byte, 512> buffer{};
  return port.receive(buffer, port.now() + 1s).value().arrival;
}

TEST(HostedStream, IsTheDeviceInMemory) {
  const auto port = open_in_memory(make_hosted(demo::emulation::StreamDevice{}));
  std::array<std::byte, 8> reply{};
  ASSERT_TRUE(port->write(hex("A5 71 8E")));
  EXPECT_EQ(port->read(reply, at(1s)), 3U);
  EXPECT_EQ(port->now(), at(1ms));
  EXPECT_FALSE(port->touch("estop", 0)) << "it has no inputs";
}

TEST(HostedStream, HasACopyThatGoesItsOwnWay) {
  const auto device = make_hosted(demo::emulation::StreamDevice{});
  device->receive(at(0s), hex("A5 71 8E"));
  const auto copy = device->clone();
  copy->advance_to(at(1s));
  EXPECT_EQ(copy->sent().size(), 1U);
  EXPECT_TRUE(device->sent().empty());
}

TEST(HostedStream, KnowsItsInputs) {
  const auto arm = make_hosted(parol6::emulation::DefectiveArm{{}, {}});
  EXPECT_FALSE(arm->inputs().empty());
  EXPECT_TRUE(arm->set_input(at(1s), "estop", 0));
  EXPECT_TRUE(make_hosted(demo::emulation::StreamDevice{})->inputs().empty());
}

TEST(HostedServer, ListensWhenItsPortIsThere) {
  const auto source = open_in_memory(make_hosted(Server{ArmPort{BenchArm{}}}));
  EXPECT_GT(source->now(), at(0s));
  const auto port = source->make_port();
  EXPECT_TRUE(port->connect(source->now() + 1s));
}

TEST(HostedServer, HasALogAndInputs) {
  const auto server = make_hosted(DefectiveServer{Server{ArmPort{BenchArm{}}}});
  EXPECT_TRUE(server->set_input(at(1s), "restart", 1));
  EXPECT_FALSE(server->inputs().empty());
  server->advance_to(at(3s));
  const auto client = server->connect(at(3s)).value();
  constexpr std::string_view kLine = "GetAbsolutePosition\r\n";
  server->receive(at(3s), client, std::as_bytes(std::span{kLine}));
  server->advance_to(at(4s));
  EXPECT_FALSE(server->take_log().empty());
  EXPECT_THAT(server->take_log(), IsEmpty()) << "each line comes once";
}

TEST(HostedServer, MayBeADeviceThatTakesOneClient) {
  const auto source = open_in_memory(make_hosted(demo::emulation::SessionDevice{}));
  const auto first = source->make_port();
  const auto second = source->make_port();
  ASSERT_TRUE(first->connect(at(1s)));
  EXPECT_EQ(second->connect(at(1s)), fail(ErrorCode::kRefused));
  EXPECT_EQ(next(*first), Arrival::kData);
  first->close();
  ASSERT_TRUE(second->connect(at(1s)));
  EXPECT_EQ(next(*second), Arrival::kData);
  EXPECT_EQ(next(*second), Arrival::kDeadline);
}

TEST(HostedServer, TakesAClientAfterOneThatTheDeviceThrewOut) {
  const auto source = open_in_memory(make_hosted(demo::emulation::SessionDevice{}));
  const auto first = source->make_port();
  const auto second = source->make_port();
  ASSERT_TRUE(first->connect(at(1s)));
  EXPECT_EQ(next(*first), Arrival::kData);
  ASSERT_TRUE(first->send(hex("00")));
  ASSERT_TRUE(second->connect(at(1s)));
  EXPECT_EQ(next(*first), Arrival::kReset);
  EXPECT_EQ(next(*second), Arrival::kData);
}

TEST(HostedServer, SaysTheEndOfAConnectionAgainAndAgain) {
  const auto source = open_in_memory(make_hosted(demo::emulation::SessionDevice{}));
  const auto port = source->make_port();
  ASSERT_TRUE(port->connect(at(1s)));
  EXPECT_EQ(next(*port), Arrival::kData);
  port->half_close();
  EXPECT_EQ(next(*port), Arrival::kEnd);
  EXPECT_EQ(next(*port), Arrival::kEnd);
}

TEST(HostedBus, MayBeASingleDevice) {
  const auto port = open_in_memory(make_hosted(i2c::Thermometer{kThermometer.value}));
  const auto choose = hex("02");
  std::array<std::byte, 1> answer{};
  const std::array messages{write_to(kThermometer, choose), read_from(kThermometer, answer)};
  EXPECT_EQ(port->transfer(messages), Transfer::kDone);
  EXPECT_FALSE(port->touch("shaft", 0));
}

TEST(HostedBus, IsAsPatientAsItIsTold) {
  const auto start = [](Duration held, auto... patience) {
    i2c::Bus bus;
    bus.attach(i2c::Thermometer{kThermometer.value});
    bus.expect({.kind = i2c::Trouble::Kind::kStretch, .duration = held});
    return open_in_memory(make_hosted(std::move(bus)), patience...)
        ->start(kThermometer, Access::kWrite);
  };
  EXPECT_EQ(start(50ms, 25ms), fail(ErrorCode::kTimedOut));
  EXPECT_EQ(start(50ms, 75ms), Ack::kAck);
  EXPECT_EQ(start(20ms), Ack::kAck);
  EXPECT_EQ(start(50ms), fail(ErrorCode::kTimedOut));
}

TEST(HostedBus, HasACopyThatGoesItsOwnWay) {
  i2c::Bus bus;
  bus.attach(i2c::Thermometer{kThermometer.value});
  bus.expect({.kind = i2c::Trouble::Kind::kStretch, .duration = 50ms});
  const auto device = make_hosted(std::move(bus));
  for (int copies = 0; copies < 2; ++copies) {
    EXPECT_EQ(open_in_memory(device->clone(), 25ms)->start(kThermometer, Access::kWrite),
              fail(ErrorCode::kTimedOut));
  }
}

}  // namespace
}  // namespace armjig
