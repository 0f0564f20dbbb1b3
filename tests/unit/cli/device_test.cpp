// SPDX-License-Identifier: Apache-2.0
#include "cli/device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "cli/devices/devices.hpp"

namespace armjig::cli {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

class ShippedDevice : public testing::TestWithParam<const Device*> {};

std::vector<const Device*> shipped() {
  std::vector<const Device*> all;
  for (const auto& device : shipped_devices()) all.push_back(&device);
  return all;
}
INSTANTIATE_TEST_SUITE_P(All, ShippedDevice, testing::ValuesIn(shipped()),
                         [](const auto& one) { return std::string{one.param->name}; });

TEST_P(ShippedDevice, HasAllPartsOfAnEntry) { EXPECT_THAT(missing_parts(*GetParam()), IsEmpty()); }

TEST_P(ShippedDevice, IsCalledTheSameByAllParts) {
  const auto& device = *GetParam();
  EXPECT_EQ(device.suite().device, device.name);
  EXPECT_EQ(device.mutants().device, device.name);
}

TEST_P(ShippedDevice, TakesItsOptionsAndNoOthers) {
  const auto& device = *GetParam();
  const RigOptions plain{.target = parse_target("emulated:").value()};
  EXPECT_TRUE(open_bench(device, plain));
  const RigOptions toast{.target = parse_target("emulated:?toast=brown").value()};
  const auto refused = open_bench(device, toast);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kUnknownOption);
  for (const auto& row : device.options()) {
    EXPECT_THAT(refused.error().hint, HasSubstr(std::string{row.name}));
  }
}

TEST(Devices, HaveDifferentNames) {
  std::set<std::string_view> names;
  for (const auto& device : shipped_devices()) EXPECT_TRUE(names.insert(device.name).second);
}

TEST(Devices, AreAllNamedWhenOneIsUnknown) {
  const auto toaster = find_device(shipped_devices(), "toaster");
  ASSERT_FALSE(toaster);
  EXPECT_EQ(toaster.error().code, ErrorCode::kUnknownDevice);
  for (const auto& device : shipped_devices()) {
    EXPECT_THAT(toaster.error().hint, HasSubstr(std::string{device.name}));
  }
}

TEST(MissingParts, AreNamedForEveryKindOfPort) {
  auto device = shipped_devices().front();
  device.suite = nullptr;
  EXPECT_THAT(missing_parts(device), Contains("suite"));
  for (const auto& port : {decltype(Device::port){OnStream{}}, {OnServer{}}, {OnBus{}}}) {
    device.port = port;
    for (const auto* part :
         {"make_judge", "emulate", "make_bench", "open_console", "watch", "make_probe"}) {
      EXPECT_THAT(missing_parts(device), Contains(part));
    }
  }
}

}  // namespace
}  // namespace armjig::cli
