// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/morap_bus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "emulators/morap/node.hpp"

namespace armjig::morap {
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

TEST(MorapBusOptions, HasOneNodeIfNothingIsSaid) {
  EXPECT_THAT(addresses_on(make_bus({}, "emulated:").value()), ElementsAre(0x12));
}

TEST(MorapBusOptions, HasTheNodesAndThePenThatOptionsName) {
  const DeviceOptions options{{"nodes", "0,7,16"}, {"pen", "yes"}, {"profile", "firmware"}};
  EXPECT_THAT(addresses_on(make_bus(options, "emulated:").value()), ElementsAre(0x10, 0x17, 0x19));
}

TEST(MorapBusOptions, KeepsNodesOffTheBusThatTheDocumentDoesNotKnow) {
  const DeviceOptions options{{"nodes", "7,8"}, {"profile", "documented"}};
  EXPECT_THAT(addresses_on(make_bus(options, "emulated:").value()), ElementsAre(0x17));
}

TEST(MorapBusOptions, NamesOptionsThatItDoesNotUnderstand) {
  const auto refused = [](const DeviceOptions& options) {
    return make_bus(options, "emulated:?...").error();
  };
  EXPECT_EQ(refused({{"node", "1"}}).code, ErrorCode::kUnknownOption);
  EXPECT_EQ(refused({{"profile", "other"}}).code, ErrorCode::kBadValue);
  EXPECT_EQ(refused({{"pen", "maybe"}}).code, ErrorCode::kBadValue);
  EXPECT_EQ(refused({{"file", "x"}, {"pen", "yes"}}).code, ErrorCode::kBadValue);
  for (const auto* nodes : {"", "17", "1,", ",1", "1;2", "x", "-1"}) {
    EXPECT_EQ(refused({{"nodes", nodes}}).code, ErrorCode::kBadValue) << nodes;
  }
}

TEST(MorapBusOptions, IsReadFromAFile) {
  auto bus = parse_bus(
      "[[node]]\nid = 3\nmotor = \"dcx26l\"\ninertia = 0.1\nload = -0.5\nprofile = \"documented\"\n"
      "[[pen]]\nhangs = false\n"
      "[[node]]\nid = 4\nhas_shaft = false\n"
      "[[thermometer]]\naddress = 0x48\ncelsius = -3.5\n",
      "a.toml");
  ASSERT_TRUE(bus) << describe(bus.error());
  EXPECT_THAT(addresses_on(*bus), ElementsAre(0x13, 0x14, 0x19, 0x48));
  EXPECT_NE(bus->device<Node>(0).plant(), nullptr);
  EXPECT_EQ(bus->device<Node>(1).plant(), nullptr);
}

TEST(MorapBusOptions, NamesTheLineOfAMistake) {
  const auto where = [](std::string_view text) { return parse_bus(text, "a.toml").error().where; };
  EXPECT_EQ(where("[[node]]\nmotor = \"dcx22l\"\n"), "a.toml:1");
  EXPECT_EQ(where("[[node]]\nid = 17\n"), "a.toml:2");
  EXPECT_EQ(where("[[node]]\nid = 1\nmotor = \"v8\"\n"), "a.toml:3");
  EXPECT_EQ(where("[[node]]\nid = 1\ninertia = 0\n"), "a.toml:3");
  EXPECT_EQ(where("[[node]]\nid = 1\nload = nan\n"), "a.toml:3");
  EXPECT_EQ(where("[[node]]\nid = 1\n[[thermometer]]\naddress = 3\n"), "a.toml:4");
  EXPECT_EQ(where("[[wheel]]\n"), "a.toml:1");
}

}  // namespace
}  // namespace armjig::morap
