// SPDX-License-Identifier: Apache-2.0
// Serial ports and USB boards, as far as a machine without any can have them: `UsbBench` stands for
// the operating system, an emulated board behind a pseudo-terminal for the one that is plugged in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "harness/link/serial_stream.hpp"
#include "tests/integration/support/program.hpp"
#include "tests/testbed/usb_bench.hpp"

namespace armjig::testing {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;

/// An emulated board in a program of its own.
class Emulator {
 public:
  Emulator() : program_{{"emulate", "parol6"}} {
    const auto line = program_.read_line();
    terminal_ = line.substr(line.find('/'));
  }
  [[nodiscard]] const std::string& terminal() const { return terminal_; }
  void stop() {
    program_.signal(SIGTERM);
    (void)program_.wait();
  }

 private:
  Program program_;
  std::string terminal_;
};

const UsbBench::Board kBoard{"ttyACM0", "0483", "5740", "42A"};
const UsbBench::Board kTwin{"ttyACM1", "0483", "5740", "42B"};
const UsbBench::Board kModem{"ttyUSB0", "0403", "6001", "A1"};

class SerialBench : public ::testing::Test {
 protected:
  [[nodiscard]] static std::unique_ptr<StreamPort> opened(const std::string& path) {
    auto port = open_serial({.path = path});
    EXPECT_TRUE(port) << port.error().where << ": " << port.error().hint;
    return port ? *std::move(port) : nullptr;
  }
  [[nodiscard]] static Ended run_one_case(const std::string& target) {
    return run_armjig(
        {"conformance", "parol6", "--target", target, "--filter", "parol6.frame.one-answer"});
  }

  UsbBench bench_;
  Emulator emulator_;
};

TEST_F(SerialBench, ListsBoardsWithTheirNumbersAndNames) {
  bench_.plug_in(kBoard, emulator_.terminal());
  const auto ports = list_serial_ports().value();
  ASSERT_EQ(ports.size(), 1U);
  EXPECT_EQ(ports[0].path, "/dev/ttyACM0");
  EXPECT_EQ(ports[0].usb, (UsbId{0x0483, 0x5740}));
  EXPECT_EQ(ports[0].manufacturer, "STMicroelectronics");
  EXPECT_EQ(ports[0].product, "PAROL6 control board");
  EXPECT_EQ(ports[0].serial_number, "42A");
}

TEST_F(SerialBench, DevicesSaysWhatToWriteBehindTarget) {
  bench_.plug_in(kBoard, emulator_.terminal());
  Program program{{"devices"}};
  EXPECT_THAT(program.read_line(), ::testing::AllOf(HasSubstr("serial:/dev/ttyACM0"),
                                                    HasSubstr("parol6"), HasSubstr("0483:5740")));
}

TEST_F(SerialBench, OpensAPortAtThreeMegabaudAndTalks) {
  bench_.plug_in(kBoard, emulator_.terminal());
  const auto ended = run_one_case("serial:/dev/ttyACM0");
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_EQ(bench_.baud_of("/dev/ttyACM0"), 3'000'000U);
}

TEST_F(SerialBench, SetsTheSpeedThatTheTargetNames) {
  bench_.plug_in(kBoard, emulator_.terminal());
  EXPECT_EQ(run_one_case("serial:/dev/ttyACM0,250000").exit_code, 0);
  EXPECT_EQ(bench_.baud_of("/dev/ttyACM0"), 250'000U);
}

TEST_F(SerialBench, FindsTheOnlyBoardOfItsKindByUsbNumbers) {
  bench_.plug_in(kModem, "/dev/null");
  bench_.plug_in(kBoard, emulator_.terminal());
  EXPECT_EQ(run_one_case("serial:0483:5740").exit_code, 0);
}

TEST_F(SerialBench, ASecondBoardOfTheKindMakesTheUserChoose) {
  bench_.plug_in(kBoard, emulator_.terminal());
  bench_.plug_in(kTwin, emulator_.terminal());
  const auto ended = run_one_case("serial:0483:5740");
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("serial:/dev/ttyACM0 or serial:/dev/ttyACM1"));
}

TEST_F(SerialBench, ASerialNumberChoosesAmongBoardsOfAKind) {
  bench_.plug_in(kTwin, "/dev/null");
  bench_.plug_in(kBoard, emulator_.terminal());
  EXPECT_EQ(run_one_case("serial:0483:5740:42A,250000").exit_code, 0);
  EXPECT_EQ(bench_.baud_of("/dev/ttyACM0"), 250'000U);
}

TEST_F(SerialBench, ABoardThatIsNotPluggedInIsNamed) {
  const auto ended = run_one_case("serial:0483:5740");
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_THAT(ended.errors, HasSubstr("serial:0483:5740"));
}

TEST_F(SerialBench, FollowsTheNamesThatUdevGives) {
  bench_.plug_in(kBoard, emulator_.terminal());
  bench_.link("/dev/armjig/parol6-42A", "../ttyACM0");
  EXPECT_EQ(run_one_case("serial:/dev/armjig/parol6-42A").exit_code, 0);
  EXPECT_EQ(bench_.baud_of("/dev/ttyACM0"), 3'000'000U);
}

TEST_F(SerialBench, APortHasOneProgramAtATime) {
  bench_.plug_in(kBoard, emulator_.terminal());
  const auto mine = opened("/dev/ttyACM0");
  const auto ended = run_one_case("serial:/dev/ttyACM0");
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_THAT(ended.errors, HasSubstr("'fuser' names it"));
}

TEST_F(SerialBench, ABoardThatGoesAwayIsDisconnected) {
  bench_.plug_in(kBoard, emulator_.terminal());
  const auto port = opened("/dev/ttyACM0");
  emulator_.stop();
  std::byte byte{};
  const auto read = port->read({&byte, 1}, port->now() + 10s);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kDisconnected);
}

TEST_F(SerialBench, APortThatWasPulledOutIsNotFound) {
  bench_.plug_in(kBoard, emulator_.terminal());
  bench_.pull_out(kBoard);
  EXPECT_EQ(run_one_case("serial:/dev/ttyACM0").exit_code, 3);
  EXPECT_TRUE(list_serial_ports()->empty());
}

}  // namespace
}  // namespace armjig::testing
