// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/impaired.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "emulators/i2c/bus.hpp"
#include "emulators/i2c/thermometer.hpp"
#include "harness/core/hex.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::string line(Instant time, const std::string& text) {
  return std::to_string(time.time_since_epoch() / 1ms) + " " + text;
}

/// What devices that repeat everything have got, outside of them.
std::vector<std::string> got;

class EchoStream : public Sending<SentBytes> {
 public:
  void receive(Instant time, Bytes bytes) {
    got.push_back(line(time, to_hex(bytes)));
    sent_.push_back({time, {bytes.begin(), bytes.end()}});
  }
  void advance_to(Instant /*time*/) {}
  [[nodiscard]] std::optional<Instant> next_event() const { return std::nullopt; }
};

class EchoServer : public Sending<ServerEvent> {
 public:
  [[nodiscard]] bool is_listening() const { return true; }
  [[nodiscard]] std::optional<ConnectionId> connect(Instant /*time*/) { return next_++; }
  void receive(Instant time, ConnectionId id, Bytes bytes) {
    note(time, id, to_hex(bytes));
    sent_.push_back({time, id, SessionEvent::Kind::kData, {bytes.begin(), bytes.end()}});
  }
  void half_close(Instant time, ConnectionId id) {
    note(time, id, "half-close");
    sent_.push_back({time, id, SessionEvent::Kind::kEnd, {}});
  }
  void close(Instant time, ConnectionId id) { note(time, id, "close"); }
  void reset(Instant time, ConnectionId id) { note(time, id, "reset"); }
  [[nodiscard]] std::size_t unread(ConnectionId /*id*/) const { return 0; }
  void advance_to(Instant /*time*/) {}
  [[nodiscard]] std::optional<Instant> next_event() const { return std::nullopt; }

 private:
  static void note(Instant time, ConnectionId id, const std::string& what) {
    got.push_back(line(time, std::to_string(id) + " " + what));
  }
  ConnectionId next_ = 0;
};

template <class Hosted>
std::unique_ptr<Hosted> impaired(std::unique_ptr<Hosted> device, std::string_view text) {
  got.clear();
  return impair(std::move(device), parse_impairment(text).value()).value();
}

std::vector<std::string> said(const HostedStream& device) {
  std::vector<std::string> all;
  for (const auto& sent : device.sent()) all.push_back(line(sent.time, to_hex(sent.bytes)));
  return all;
}
std::vector<std::string> said(const HostedServer& device) {
  std::vector<std::string> all;
  for (const auto& sent : device.sent()) {
    const auto kind = sent.kind == SessionEvent::Kind::kData  ? to_hex(sent.bytes)
                      : sent.kind == SessionEvent::Kind::kEnd ? "end"
                                                              : "reset";
    all.push_back(line(sent.time, std::to_string(sent.connection) + " " + kind));
  }
  return all;
}

const auto kOne = *from_hex("01");
const auto kTwo = *from_hex("02");

TEST(ImpairedDevice, AStreamIsDelayedBothWaysAndSaysWhenItActsNext) {
  const auto device = impaired(make_hosted(EchoStream{}), "out.delay=3ms,in.delay=5ms");
  device->receive(at(1ms), kOne);
  EXPECT_EQ(device->next_event(), at(4ms));
  device->advance_to(at(4ms));
  EXPECT_THAT(got, ElementsAre("4 01"));
  EXPECT_THAT(said(*device), IsEmpty());
  EXPECT_EQ(device->next_event(), at(9ms));
  device->advance_to(at(9ms));
  EXPECT_THAT(said(*device), ElementsAre("9 01"));
  EXPECT_EQ(device->next_event(), std::nullopt);
}

TEST(ImpairedDevice, OneLongStepIsLikeManyShortOnes) {
  const auto whole = impaired(make_hosted(EchoStream{}), "delay=uniform(1ms,9ms),split=random");
  const auto steps = impaired(make_hosted(EchoStream{}), "delay=uniform(1ms,9ms),split=random");
  const auto bytes = *from_hex("0102030405060708");
  for (const auto& device : {whole.get(), steps.get()}) device->receive(at(1ms), bytes);
  for (auto time = 1ms; time < 40ms; time += 1ms) steps->advance_to(at(time));
  for (const auto& device : {whole.get(), steps.get()}) device->advance_to(at(40ms));
  EXPECT_THAT(said(*whole), ::testing::Not(IsEmpty()));
  EXPECT_EQ(said(*whole), said(*steps));
}

TEST(ImpairedDevice, WhatIsLostNeverArrives) {
  const auto device = impaired(make_hosted(EchoStream{}), "out.loss=100%");
  device->receive(at(1ms), kOne);
  device->advance_to(at(1s));
  EXPECT_THAT(got, IsEmpty());
  EXPECT_EQ(device->unread(), 0U);
}

TEST(ImpairedDevice, AProgramThatOutrunsTheLinkHasToWait) {
  const auto device = impaired(make_hosted(EchoStream{}), "bandwidth=1000");
  const std::vector<std::byte> much(std::size_t{1} << 20);
  device->receive(at(1ms), much);
  EXPECT_EQ(device->unread(), 0U);
  device->receive(at(1ms), kOne);
  EXPECT_GT(device->unread(), much.size());
}

TEST(ImpairedDevice, AStreamThatIsServedDoesNotBreak) {
  const auto made = impair(make_hosted(EchoStream{}), parse_impairment("disconnect=1%").value());
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(made.error().where, HasSubstr("disconnect"));
  EXPECT_FALSE(
      impair(make_hosted(EchoStream{}), parse_impairment("in.disconnect-after=9").value()));
}

TEST(ImpairedDevice, ConnectionsToAServerAreDelayedEachForItself) {
  const auto device = impaired(make_hosted(EchoServer{}), "out.delay=3ms,in.delay=5ms");
  EXPECT_EQ(device->connect(at(1ms)), 0U);
  EXPECT_EQ(device->connect(at(2ms)), 1U);
  device->receive(at(2ms), 1, kTwo);
  device->receive(at(3ms), 0, kOne);
  device->half_close(at(3ms), 0);
  device->advance_to(at(20ms));
  EXPECT_THAT(got, ElementsAre("5 1 02", "6 0 01", "6 0 half-close"));
  EXPECT_THAT(said(*device), ElementsAre("10 1 02", "11 0 01", "11 0 end"));
  EXPECT_EQ(device->next_event(), std::nullopt);
}

TEST(ImpairedDevice, ABrokenConnectionIsResetOnBothSides) {
  const auto device = impaired(make_hosted(EchoServer{}), "out.disconnect-after=1");
  ASSERT_EQ(device->connect(at(1ms)), 0U);
  device->receive(at(2ms), 0, kOne);
  device->receive(at(3ms), 0, kTwo);
  device->advance_to(at(9ms));
  ASSERT_THAT(got, ::testing::Not(IsEmpty()));
  EXPECT_THAT(got.back(), HasSubstr("0 reset"));
  ASSERT_THAT(said(*device), ::testing::Not(IsEmpty()));
  EXPECT_THAT(said(*device).back(), HasSubstr("0 reset"));
  device->clear_sent();
  device->receive(at(10ms), 0, kOne);
  device->advance_to(at(20ms));
  EXPECT_THAT(said(*device), IsEmpty()) << "nobody is told any more of it";
}

TEST(ImpairedDevice, WhoClosesAConnectionLeavesNothingBehind) {
  const auto device = impaired(make_hosted(EchoServer{}), "delay=50ms");
  ASSERT_EQ(device->connect(at(1ms)), 0U);
  device->receive(at(2ms), 0, kOne);
  device->close(at(3ms), 0);
  EXPECT_THAT(got, ElementsAre("3 0 01", "3 0 close"));
  ASSERT_EQ(device->connect(at(4ms)), 1U);
  device->receive(at(4ms), 1, kOne);
  device->reset(at(5ms), 1);
  device->advance_to(at(90ms));
  EXPECT_THAT(got, SizeIs(3));
  EXPECT_EQ(got.back(), "5 1 reset") << "what was on its way is lost";
}

std::unique_ptr<HostedBus> bus_with_thermometer() {
  i2c::Bus bus;
  bus.attach(i2c::Thermometer{0x48});
  return make_hosted(std::move(bus));
}

TEST(ImpairedDevice, ABusThatLosesEverythingAnswersNobody) {
  const auto good = impaired(bus_with_thermometer(), "loss=0%");
  EXPECT_EQ(good->start(at(1ms), 0x48, false).outcome, BusReply::Outcome::kAck);
  EXPECT_EQ(good->write(at(2ms), std::byte{0}).outcome, BusReply::Outcome::kAck);
  EXPECT_EQ(good->stop(at(3ms)).outcome, BusReply::Outcome::kAck);
  EXPECT_EQ(good->start(at(4ms), 0x49, false).outcome, BusReply::Outcome::kNack);
  const auto bad = impaired(bus_with_thermometer(), "out.loss=100%");
  EXPECT_EQ(bad->start(at(1ms), 0x48, false).outcome, BusReply::Outcome::kNack);
  const auto read = impaired(bus_with_thermometer(), "in.loss=100%");
  EXPECT_EQ(read->start(at(1ms), 0x48, true).outcome, BusReply::Outcome::kAck);
  EXPECT_EQ(read->read(at(2ms)).byte, std::byte{0xFF}) << "an idle line";
}

TEST(ImpairedDevice, ADelayOfABusHoldsItsClock) {
  const auto usual = impaired(bus_with_thermometer(), "loss=0%")->start(at(1ms), 0x48, false).end;
  const auto bad = impaired(bus_with_thermometer(), "out.delay=2ms");
  EXPECT_EQ(bad->start(at(1ms), 0x48, false).end, usual + 2ms);
}

TEST(ImpairedDevice, ABusCannotSplitOrReorder) {
  const auto made = impair(bus_with_thermometer(), parse_impairment("split=random").value());
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace armjig
