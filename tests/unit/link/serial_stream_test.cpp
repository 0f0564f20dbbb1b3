// SPDX-License-Identifier: Apache-2.0
// What needs no port. Ports: tests/testbed/serial_stream_test.cpp.
#include "harness/link/serial_stream.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "emulators/host/pseudo_terminal.hpp"

namespace armjig {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

TEST(SerialAddress, HasAPathAndTheUsualSpeed) {
  const auto address = parse_serial_address("/dev/ttyACM0").value();
  EXPECT_EQ(address.path, "/dev/ttyACM0");
  EXPECT_EQ(address.line.baud, 3'000'000U);
}

TEST(SerialAddress, HasTheSpeedBehindTheLastComma) {
  EXPECT_EQ(parse_serial_address("/dev/ttyUSB1,9600"),
            (SerialAddress{"/dev/ttyUSB1", {.baud = 9600}}));
  EXPECT_EQ(parse_serial_address("/dev/a,b,115200"),
            (SerialAddress{"/dev/a,b", {.baud = 115'200}}));
}

TEST(SerialAddress, HasTheLineOfTheDeviceButTheSpeedThatIsWritten) {
  const SerialLine line{.baud = 1200, .parity = Parity::kEven, .stop_bits = 2};
  EXPECT_EQ(parse_serial_address("/dev/ttyS0", line), (SerialAddress{"/dev/ttyS0", line}));
  EXPECT_EQ(parse_serial_address("/dev/ttyS0,9600", line)->line,
            (SerialLine{.baud = 9600, .parity = Parity::kEven, .stop_bits = 2}));
}

TEST(SerialStream, APseudoTerminalIsSentToItsOwnScheme) {
  const auto terminal = PseudoTerminal::open().value();
  const auto port = open_serial({.path = terminal.path()});
  ASSERT_FALSE(port);
  EXPECT_EQ(port.error().code, ErrorCode::kBadTarget);
  EXPECT_THAT(port.error().hint, HasSubstr("pty:" + terminal.path()));
}

TEST(SerialStream, AFileIsNoPort) {
  const auto path = fs::temp_directory_path() / "armjig-serial-stream-test";
  std::ofstream{path} << "no port";
  const auto port = open_serial({.path = path});
  fs::remove(path);
  ASSERT_FALSE(port);
  EXPECT_EQ(port.error().code, ErrorCode::kBadTarget);
  EXPECT_THAT(port.error().hint, HasSubstr("armjig devices"));
}

}  // namespace
}  // namespace armjig
