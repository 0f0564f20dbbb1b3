// SPDX-License-Identifier: Apache-2.0
#include "emulators/lab/i2c_adapter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "conformance/program_check.hpp"
#include "emulators/host/served.hpp"
#include "emulators/morap/options.hpp"
#include "harness/core/hex.hpp"

namespace armjig {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr BusAddress kNode{0x12};
constexpr BusAddress kThermometer{0x48};
constexpr BusAddress kNobody{0x30};

i2c::Bus bus() {
  return morap::emulation::make_bus(
      {.nodes = {{}}, .thermometers = {i2c::Thermometer{kThermometer.value}}});
}

std::vector<std::string> overheard;
std::vector<Instant> overheard_at;

/// A judge that writes down what it is shown.
class Overhearing final : public ProgramChecker {
 public:
  explicit Overhearing(const LinkNoise& /*noise*/) {}

  void to_device(Instant time, Bytes message) override {
    overheard.push_back(to_hex(message));
    overheard_at.push_back(time);
  }
  void from_device(Instant time, Bytes message) override { to_device(time, message); }
  void finish(Instant /*time*/) override {}
  [[nodiscard]] std::size_t messages() const noexcept override { return overheard.size(); }
};

/// What is heard of an adapter's bus.
class I2cAdapterTest : public ::testing::Test {
 protected:
  I2cAdapterTest() {
    overheard.clear();
    overheard_at.clear();
  }

  int transfer(const std::vector<BusMessage>& messages) { return adapter->transfer(messages); }

  ProgramCheck check{
      {"test", []() noexcept { return std::span<const Requirement>{}; }, make_checker<Overhearing>},
      {},
      [](const Offence& /*offence*/) {}};
  std::unique_ptr<Served> served =
      serve_aside(Host::open(check.watch(make_hosted(bus())), {}).value());
  std::unique_ptr<I2cAdapter> adapter = std::make_unique<I2cAdapter>(served->host());
};

TEST_F(I2cAdapterTest, TellsWhatWasAcknowledgedOfEachMessage) {
  const auto choose = *from_hex("88");
  std::array<std::byte, 2> answer{};
  EXPECT_EQ(transfer({write_to(kNode, choose), read_from(kNode, answer)}), 0);
  EXPECT_THAT(overheard, ElementsAre("2488", "251212"));
  EXPECT_LT(overheard_at[0], overheard_at[1]);
}

TEST_F(I2cAdapterTest, TellsNothingOfAnAddressWhereNobodyIs) {
  const auto bytes = *from_hex("88");
  EXPECT_EQ(transfer({write_to(kNobody, bytes)}), ENXIO);
  EXPECT_THAT(overheard, IsEmpty());
}

TEST_F(I2cAdapterTest, LeavesOutTheByteThatWasRefused) {
  const auto bytes = *from_hex("09");
  EXPECT_EQ(transfer({write_to(kThermometer, bytes)}), EIO);
  EXPECT_THAT(overheard, ElementsAre("90"));
}

TEST_F(I2cAdapterTest, TellsOfSmbusCommandsToo) {
  i2c_smbus_data data{};
  EXPECT_EQ(adapter->smbus(kNode, Access::kRead, 0x83, I2C_SMBUS_BYTE_DATA, data), 0);
  EXPECT_EQ(adapter->smbus(kNode, Access::kWrite, 0, I2C_SMBUS_QUICK, data), 0);
  EXPECT_THAT(overheard, ElementsAre("2483", "2503", "24"));
}

TEST_F(I2cAdapterTest, TellsOneThingAtATimeWhoeverTalks) {
  constexpr int kEach = 20;
  const auto talk = [this] {
    const auto bytes = *from_hex("83");
    for (int i = 0; i < kEach; ++i) EXPECT_EQ(transfer({write_to(kNode, bytes)}), 0);
  };
  std::thread other{talk};
  talk();
  other.join();
  EXPECT_EQ(overheard.size(), 2U * kEach);
  EXPECT_TRUE(std::ranges::is_sorted(overheard_at));
}

}  // namespace
}  // namespace armjig
