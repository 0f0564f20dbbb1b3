// SPDX-License-Identifier: Apache-2.0
// What people can do beside a hosted PAROL6.
#include <gtest/gtest.h>

#include <string>

#include "emulators/memory/hosted.hpp"
#include "emulators/parol6/options.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::host {
namespace {

using namespace std::chrono_literals;

std::unique_ptr<HostedStream> arm(const DeviceOptions& options = {}) {
  return make_hosted(emulation::make(options, "test").value());
}

/// What the board says at `time`.
TelemetryFrame asked(HostedStream& device, Duration time) {
  device.clear_sent();
  device.receive(at(time), encode(CommandFrame{.command = Command::kIdle}));
  device.advance_to(at(time + 5ms));
  EXPECT_EQ(device.sent().size(), 1U);
  const Bytes bytes{device.sent().front().bytes};
  return decode_telemetry(body_of(bytes.first<kTelemetryFrameSize>()));
}

TEST(Parol6Inputs, AreAllKnown) {
  const auto device = arm();
  for (const auto& input : device->inputs()) {
    std::string name{input.name};
    if (!name.ends_with('N')) {
      EXPECT_TRUE(device->set_input(at(1s), name, 1)) << name;
      continue;
    }
    for (char joint = '1'; joint <= '6'; ++joint) {
      name.back() = joint;
      EXPECT_TRUE(device->set_input(at(1s), name, 1)) << name;
    }
  }
}

TEST(Parol6Inputs, AreNoOthersAndTakeNoValueThatMeansNothing) {
  const auto device = arm();
  for (const auto* name :
       {"", "estop ", "in3", "switch.jN", "switch.j0", "switch.j7", "power.j1"}) {
    EXPECT_FALSE(device->set_input(at(1s), name, 0)) << name;
  }
  EXPECT_FALSE(device->set_input(at(1s), "switch.j1", 3));
  EXPECT_FALSE(device->set_input(at(1s), "between-fingers", 256));
  EXPECT_FALSE(device->set_input(at(1s), "between-fingers", -2));
  EXPECT_FALSE(device->set_input(at(1s), "position.j1", std::int64_t{1} << 31));
}

TEST(Parol6Inputs, ShowInTelemetry) {
  const auto device = arm();
  EXPECT_FALSE(is_estop_pressed(asked(*device, 1s)));
  ASSERT_TRUE(device->set_input(at(2s), "estop", 0));
  ASSERT_TRUE(device->set_input(at(2s), "in2", 1));
  const auto pressed = asked(*device, 2s);
  EXPECT_TRUE(is_estop_pressed(pressed));
  EXPECT_EQ(pressed.io & (io_flag::kIn1 | io_flag::kIn2), io_flag::kIn2);
  ASSERT_TRUE(device->set_input(at(3s), "estop", 1));
  EXPECT_FALSE(is_estop_pressed(asked(*device, 3s)));
}

TEST(Parol6Inputs, ReachABoardWithFaultsToo) {
  const auto device = arm({{"fault", "swap-bytes:speed.j1"}});
  ASSERT_TRUE(device->set_input(at(1s), "estop", 0));
  EXPECT_TRUE(is_estop_pressed(asked(*device, 1s)));
}

}  // namespace
}  // namespace armjig::parol6::host
