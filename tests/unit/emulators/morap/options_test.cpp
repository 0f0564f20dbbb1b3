// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/support/options.hpp"

namespace armjig::morap::emulation {
namespace {

using ::testing::ElementsAre;

std::vector<int> addresses_on(i2c::Bus bus) {
  std::vector<int> found;
  Instant time{};
  for (std::uint8_t address = 0; address < 0x80; ++address) {
    const auto reply = bus.start(time, address, /*is_read=*/false);
    if (reply.outcome == BusReply::Outcome::kAck) found.push_back(address);
    time = bus.stop(reply.end).end;
  }
  return found;
}

TEST(MorapOptions, HasOneNodeIfNothingIsSaid) {
  EXPECT_THAT(addresses_on(make({}, "emulated:").value()), ElementsAre(0x12));
}

TEST(MorapOptions, HasTheNodesAndThePenThatOptionsName) {
  const DeviceOptions options{{"nodes", "0,7,16"}, {"pen", "yes"}, {"profile", "firmware"}};
  EXPECT_THAT(addresses_on(make(options, "emulated:").value()), ElementsAre(0x10, 0x17, 0x19));
}

TEST(MorapOptions, KeepsNodesOffTheBusThatTheDocumentDoesNotKnow) {
  const DeviceOptions options{{"nodes", "7,8"}, {"profile", "documented"}};
  EXPECT_THAT(addresses_on(make(options, "emulated:").value()), ElementsAre(0x17));
}

TEST(MorapOptions, NamesOptionsThatItDoesNotUnderstand) {
  const auto refused = [](const DeviceOptions& options) {
    return make(options, "emulated:?...").error();
  };
  EXPECT_EQ(refused({{"node", "1"}}).code, ErrorCode::kUnknownOption);
  EXPECT_EQ(refused({{"profile", "other"}}).code, ErrorCode::kBadValue);
  EXPECT_EQ(refused({{"pen", "maybe"}}).code, ErrorCode::kBadValue);
  EXPECT_EQ(refused({{"file", "x"}, {"pen", "yes"}}).code, ErrorCode::kBadValue);
  for (const auto* nodes : {"", "17", "1,", ",1", "1;2", "x", "-1"}) {
    EXPECT_EQ(refused({{"nodes", nodes}}).code, ErrorCode::kBadValue) << nodes;
  }
}

TEST(MorapOptions, HoldForAllNodesWithFaultsAndLoads) {
  const DeviceOptions given{
      {"nodes", "1,3"}, {"inertia", "0.2"}, {"fault", "law:wind-up,quirk:none"}};
  EXPECT_EQ(make(given, "emulated:").error().where, "emulated:, fault=quirk:none");
  auto bus = read_bus({{"nodes", "1,3"}, {"inertia", "0.2"}, {"fault", "law:wind-up"}}, "").value();
  ASSERT_EQ(bus.nodes.size(), 2U);
  EXPECT_EQ(&bus.nodes[0].known_motor(), &kDcx26l);
  EXPECT_EQ(&bus.nodes[1].known_motor(), &kDcx22l);
  for (const auto& node : bus.nodes) {
    EXPECT_EQ(node.inertia, 0.2);
    EXPECT_EQ(node.viscous, 0.1);
    EXPECT_THAT(node.faults, ElementsAre("law:wind-up"));
  }
}

TEST(MorapOptions, ArePassedToTheDeviceWithTheInput) {
  auto bus = make({{"pen", "yes"}}, "emulated:").value();
  EXPECT_NE(bus.device<DefectiveNode>(0).node().plant(), nullptr);
  EXPECT_TRUE(bus.set_input(Instant{}, "shaft", 0));
  EXPECT_EQ(bus.device<DefectiveNode>(0).node().plant(), nullptr);
  EXPECT_FALSE(bus.set_input(Instant{}, "colour", 0));
}

TEST(MorapOptions, TakeTheirDocumentedValues) {
  const OptionFiles files{
      .read_groups = [](const std::string&) { return std::vector<OptionGroup>{}; }};
  expect_documented_values(options(),
                           [&](const DeviceOptions& given, const std::string& where) {
                             return make(given, where, files).map([](const auto&) {});
                           },
                           {{"fault", {"law:wind-up", "law:none"}}, {"file", {"nodes.toml", ""}}});
}

}  // namespace
}  // namespace armjig::morap::emulation
