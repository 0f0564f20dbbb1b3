// SPDX-License-Identifier: Apache-2.0
// A bus of MORAP nodes from a file (emulators/morap/options.hpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "emulators/morap/options.hpp"
#include "harness/config/option_file.hpp"
#include "harness/config/toml_table.hpp"

namespace armjig::morap::emulation {
namespace {

/// The bus of a file with this text, and further options.
Outcome<BusSettings> bus_of(const std::string& text, DeviceOptions options = {}) {
  const OptionFiles files{.read_groups = [&text](const std::string& path) {
    return TomlTable::parse(text, path).and_then([](TomlTable table) { return table.groups(); });
  }};
  options["file"] = "a.toml";
  return read_bus(options, "emulated:", files);
}

TEST(NodesFile, HasAllThatIsOnTheBus) {
  const auto bus = bus_of(
      "[[node]]\nid = 3\nmotor = \"dcx26l\"\ninertia = 0.1\nload = -0.5\nprofile = \"documented\"\n"
      "[[pen]]\nhangs = false\n"
      "[[node]]\nid = 4\nhas_shaft = false\nfault = \"law:wind-up\"\n"
      "[[thermometer]]\naddress = 0x48\ncelsius = -3.5\n");
  ASSERT_TRUE(bus) << describe(bus.error());
  ASSERT_EQ(bus->nodes.size(), 2U);
  EXPECT_EQ(bus->nodes[0].id, 3);
  EXPECT_EQ(bus->nodes[0].motor, &kDcx26l);
  EXPECT_EQ(bus->nodes[0].inertia, 0.1);
  EXPECT_EQ(bus->nodes[0].load, -0.5);
  EXPECT_FALSE(bus->nodes[0].profile.has_undocumented);
  EXPECT_TRUE(bus->nodes[0].has_shaft);
  EXPECT_FALSE(bus->nodes[1].has_shaft);
  EXPECT_THAT(bus->nodes[1].faults, testing::ElementsAre("law:wind-up"));
  ASSERT_EQ(bus->pens.size(), 1U);
  EXPECT_FALSE(bus->pens[0].hangs_on_surplus);
  ASSERT_EQ(bus->thermometers.size(), 1U);
  EXPECT_TRUE(bus->thermometers[0].acknowledges(0x48));
  auto devices = make_bus(*bus);
  EXPECT_NE(devices.device<DefectiveNode>(0).node().plant(), nullptr);
  EXPECT_EQ(devices.device<DefectiveNode>(1).node().plant(), nullptr);
}

TEST(NodesFile, LeavesToOptionsWhatItDoesNotSay) {
  const auto bus = bus_of("[[node]]\nid = 1\ndry = 0.3\n", {{"dry", "0.2"}, {"viscous", "0.7"}});
  ASSERT_TRUE(bus) << describe(bus.error());
  EXPECT_EQ(bus->nodes[0].dry, 0.3);
  EXPECT_EQ(bus->nodes[0].viscous, 0.7);
}

TEST(NodesFile, NamesTheLineOfAMistake) {
  const auto where = [](const std::string& text) { return bus_of(text).error().where; };
  EXPECT_EQ(where("[[node]]\nmotor = \"dcx22l\"\n"), "a.toml:1");
  EXPECT_EQ(where("[[node]]\nid = 17\n"), "a.toml:2, id=17");
  EXPECT_EQ(where("[[node]]\nid = 1.5\n"), "a.toml:2, id=1.5");
  EXPECT_EQ(where("[[node]]\nid = 1\nmotor = \"v8\"\n"), "a.toml:3, motor=v8");
  EXPECT_EQ(where("[[node]]\nid = 1\ninertia = 0\n"), "a.toml:3, inertia=0");
  EXPECT_EQ(where("[[node]]\nid = 1\nload = nan\n"), "a.toml:3, load=nan");
  EXPECT_EQ(where("[[node]]\nid = 1\ncolour = 3\n"), "a.toml:3, colour");
  EXPECT_EQ(where("[[node]]\nid = 1\n[[thermometer]]\naddress = 3\n"), "a.toml:4, address=3");
  EXPECT_EQ(where("[[wheel]]\n"), "a.toml:1");
  EXPECT_EQ(where("id = 1\n"), "a.toml:1");
  EXPECT_EQ(where("[[node]\n"), "a.toml:1");
}

TEST(NodesFile, IsReadFromDisk) {
  const auto missing = read_bus({{"file", "/nonexistent"}}, "emulated:", option_files());
  EXPECT_EQ(missing.error().code, ErrorCode::kCannotRead);
  EXPECT_EQ(read_bus({{"file", "/"}}, "emulated:", option_files()).error().code,
            ErrorCode::kCannotRead);
}

}  // namespace
}  // namespace armjig::morap::emulation
