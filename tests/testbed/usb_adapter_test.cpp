// SPDX-License-Identifier: Apache-2.0
// I2C adapters on USB through the real libusb. The kernel below it is played by `UsbfsDevice`, the
// adapter at the end of the cable by `TinyUsbAdapter`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include "harness/core/hex.hpp"
#include "harness/drive/morap/joint.hpp"
#include "harness/link/i2c_tiny_usb.hpp"
#include "harness/link/usb_stream.hpp"
#include "tests/integration/support/program.hpp"
#include "tests/testbed/usb_bench.hpp"
#include "tests/testbed/usbfs_device.hpp"
#include "tests/unit/link/tiny_usb_adapter.hpp"

namespace armjig::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const UsbfsDevice::Identity kAdapter{2, {0x0403, 0xC631}, "7A"};
const UsbfsDevice::Identity kTwinAdapter{3, {0x0403, 0xC631}, "7B"};
const UsbfsDevice::Identity kCousin{2, {0x1C40, 0x0534}, "7A"};
const UsbfsDevice::Identity kUsbModem{2, {0x0403, 0x6001}, "A1"};
constexpr BusAddress kNode{0x12};
constexpr BusAddress kNobody{0x13};

/// An adapter on the bench.
class Plugged {
 public:
  Plugged(const UsbBench& bench, const UsbfsDevice::Identity& identity,
          TinyUsbAdapter::Behaviour behaviour = {})
      : adapter_{behaviour, log_}, device_{bench, identity, adapter_} {}

  [[nodiscard]] UsbfsDevice& device() noexcept { return device_; }
  /// Whether somebody opened its bus.
  [[nodiscard]] bool is_in_use() const noexcept { return log_->delay.has_value(); }
  [[nodiscard]] std::size_t message_count() const noexcept { return log_->requests.size(); }

 private:
  std::shared_ptr<TinyUsbAdapter::Log> log_ = std::make_shared<TinyUsbAdapter::Log>();
  TinyUsbAdapter adapter_;
  UsbfsDevice device_;
};

/// Takes from this thread what root may do and others may not, as long as it lives.
class NoPrivileges {
 public:
  NoPrivileges() {
    ::syscall(SYS_capget, &header_, kept_.data());
    auto none = kept_;
    for (auto& half : none) half.effective = 0;
    ::syscall(SYS_capset, &header_, none.data());
  }
  NoPrivileges(const NoPrivileges&) = delete;
  NoPrivileges& operator=(const NoPrivileges&) = delete;
  ~NoPrivileges() { ::syscall(SYS_capset, &header_, kept_.data()); }

 private:
  __user_cap_header_struct header_{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> kept_{};
};

std::unique_ptr<BusPort> opened(const std::string& serial_number = "") {
  auto port = open_i2c_tiny_usb(serial_number);
  EXPECT_TRUE(port) << port.error().where << ": " << port.error().hint;
  return port ? *std::move(port) : nullptr;
}

Problem problem_of_opening(const std::string& serial_number = "") {
  const auto port = open_i2c_tiny_usb(serial_number);
  EXPECT_FALSE(port);
  return port ? Problem{} : port.error();
}

Result<Transfer> poke(BusPort& port, BusAddress address) {
  const auto message = write_to(address, {});
  return port.transfer({&message, 1});
}

ErrorCode error_of_poke(BusPort& port) {
  const auto done = poke(port, kNode);
  EXPECT_FALSE(done);
  return done ? ErrorCode{} : done.error().code;
}

class UsbAdapterBench : public ::testing::Test {
 protected:
  UsbBench bench_;
};

TEST_F(UsbAdapterBench, CarriesWhatADriveSaysAndHears) {
  const Plugged adapter{bench_, kAdapter};
  const auto port = opened();
  ASSERT_TRUE(port);
  morap::drive::Master master{*port};
  morap::drive::Joint joint{master, kNode};
  EXPECT_EQ(joint.calibrate(morap::drive::Angle{1.0F}), morap::drive::BusCode::kOk);
  // captures/morap: 1 rad is 18840 counts, which read as 0.9999935
  EXPECT_FLOAT_EQ(joint.angle().value.value, 0.9999935F);
}

TEST_F(UsbAdapterBench, TheLastMessageOfAProgramStopsANode) {
  const Plugged adapter{bench_, kAdapter};
  const auto port = opened();
  ASSERT_TRUE(port);
  morap::drive::Master master{*port};
  morap::drive::Joint joint{master, kNode};
  ASSERT_EQ(joint.calibrate(morap::drive::Angle{0.0F}), morap::drive::BusCode::kOk);
  const auto moves = from_hex("02 00 00 80 3F").value();
  const auto reference = write_to(kNode, moves);
  ASSERT_EQ(port->transfer({&reference, 1}), Transfer::kDone);
  const auto lifeline = port->lifeline();
  ASSERT_TRUE(lifeline);
  lifeline->send(lifeline->descriptor, from_hex("24 00").value());
  const auto select = from_hex("83").value();
  std::array<std::byte, 1> status{};
  ASSERT_EQ(port->transfer(std::array{write_to(kNode, select), read_from(kNode, status)}),
            Transfer::kDone);
  EXPECT_EQ(status[0], std::byte{2}) << "disabled";
}

TEST_F(UsbAdapterBench, KnowsBothNumbersOfTheFamily) {
  const Plugged adapter{bench_, kCousin};
  EXPECT_TRUE(opened());
}

TEST_F(UsbAdapterBench, TellsWhoIsNotThere) {
  const Plugged adapter{bench_, kAdapter};
  const auto port = opened();
  ASSERT_TRUE(port);
  EXPECT_EQ(poke(*port, kNode), Transfer::kDone);
  EXPECT_EQ(poke(*port, kNobody), Transfer::kAddressRefused);
}

TEST_F(UsbAdapterBench, AShortTransferIsARefusedByte) {
  const Plugged adapter{bench_, kAdapter, {.is_cut_short = true}};
  const auto port = opened();
  ASSERT_TRUE(port);
  std::array<std::byte, 4> answer{};
  const auto read = read_from(kNode, answer);
  EXPECT_EQ(port->transfer({&read, 1}), Transfer::kByteRefused);
  const auto write = write_to(kNode, answer);
  EXPECT_EQ(port->transfer({&write, 1}), Transfer::kByteRefused);
}

TEST_F(UsbAdapterBench, AMessageThatIsTooLongForUsbIsRefusedBeforeTheFirst) {
  const Plugged adapter{bench_, kAdapter};
  const auto port = opened();
  ASSERT_TRUE(port);
  std::vector<std::byte> answer(4096);
  const auto longest = read_from(kNode, answer);
  EXPECT_EQ(port->transfer({&longest, 1}), Transfer::kDone);
  answer.emplace_back();
  const auto before = adapter.message_count();
  const std::array messages{write_to(kNode, {}), read_from(kNode, answer)};
  const auto done = port->transfer(messages);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kBadValue);
  EXPECT_EQ(adapter.message_count(), before);
}

TEST_F(UsbAdapterBench, AScanFindsTheNodeBehindIt) {
  const Plugged adapter{bench_, kAdapter};
  Program program{{"i2c", "scan", "--target", "i2c-tiny-usb:"}};
  EXPECT_EQ(program.read_line(), "0x12  MORAP node 2");
  EXPECT_EQ(program.wait(), 0) << program.read_errors();
}

/// The next line with all of these words; what there is when the program says no more.
std::string line_with(Program& program, const std::string& words) {
  auto line = program.read_line();
  while (!line.empty() && line.find(words) == std::string::npos) line = program.read_line();
  return line;
}

TEST_F(UsbAdapterBench, AWatchGoesOnWhenItIsBack) {
  auto adapter = std::make_unique<Plugged>(bench_, kAdapter);
  Program program{{"watch", "morap", "--target", "i2c-tiny-usb:", "--reconnect", "--json"}};
  EXPECT_THAT(line_with(program, "angle_rad"), HasSubstr("armjig.morap-node/1"));
  adapter->device().pull_out();
  adapter.reset();
  EXPECT_THAT(line_with(program, "error"), HasSubstr("the bus is away"));
  adapter = std::make_unique<Plugged>(bench_, kAdapter);
  EXPECT_THAT(line_with(program, "angle_rad"), HasSubstr("armjig.morap-node/1"));
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 0) << program.read_errors();
}

TEST_F(UsbAdapterBench, AWatchEndsInOneLineWhenItIsPulledOut) {
  Plugged adapter{bench_, kAdapter};
  Program program{{"watch", "morap", "--target", "i2c-tiny-usb:", "--json"}};
  EXPECT_THAT(line_with(program, "angle_rad"), HasSubstr("armjig.morap-node/1"));
  adapter.device().pull_out();
  EXPECT_EQ(program.wait(), 3);
  EXPECT_THAT(program.read_errors(), HasSubstr("i2c-tiny-usb:"));
}

TEST_F(UsbAdapterBench, IsNotFoundWhereNoneIsPluggedIn) {
  const auto problem = problem_of_opening();
  EXPECT_EQ(problem.code, ErrorCode::kNotFound);
  EXPECT_EQ(problem.where, "i2c-tiny-usb:");
}

TEST_F(UsbAdapterBench, LeavesOtherDevicesAlone) {
  const Plugged modem{bench_, kUsbModem};
  EXPECT_EQ(problem_of_opening().code, ErrorCode::kNotFound);
}

TEST_F(UsbAdapterBench, ASecondOneMakesTheUserChoose) {
  const Plugged adapter{bench_, kAdapter};
  const Plugged twin{bench_, kTwinAdapter};
  const auto problem = problem_of_opening();
  EXPECT_EQ(problem.code, ErrorCode::kBadTarget);
  EXPECT_THAT(problem.hint, AllOf(HasSubstr("'7A' at 1-2"), HasSubstr("'7B' at 1-3")));
  EXPECT_FALSE(adapter.is_in_use() || twin.is_in_use());
}

TEST_F(UsbAdapterBench, ASerialNumberChooses) {
  const Plugged adapter{bench_, kAdapter};
  const Plugged twin{bench_, kTwinAdapter};
  EXPECT_TRUE(opened("7B"));
  EXPECT_TRUE(twin.is_in_use());
  EXPECT_FALSE(adapter.is_in_use());
}

TEST_F(UsbAdapterBench, AnotherSerialNumberIsNotFound) {
  const Plugged adapter{bench_, kAdapter};
  EXPECT_EQ(problem_of_opening("7").code, ErrorCode::kNotFound);
}

TEST_F(UsbAdapterBench, HasOneProgramAtATime) {
  const Plugged adapter{bench_, kAdapter};
  const auto port = opened();
  const auto problem = problem_of_opening();
  EXPECT_EQ(problem.code, ErrorCode::kBusy);
  EXPECT_THAT(problem.hint, HasSubstr("rmmod i2c-tiny-usb"));
}

TEST_F(UsbAdapterBench, SaysThatAUdevRuleIsMissing) {
  Plugged adapter{bench_, kAdapter};
  ASSERT_EQ(::chmod(adapter.device().file().c_str(), S_ISVTX), 0);
  const NoPrivileges like_everybody;
  const auto problem = problem_of_opening();
  EXPECT_EQ(problem.code, ErrorCode::kNoPermission);
  EXPECT_THAT(problem.hint, HasSubstr("udev rule 60-armjig.rules"));
  EXPECT_THAT(problem.hint,
              HasSubstr(R"(ATTR{idVendor}=="0403", ATTR{idProduct}=="c631", TAG+="uaccess")"));
}

TEST_F(UsbAdapterBench, RefusesADeviceThatIsNoSuchAdapter) {
  const Plugged adapter{bench_, kAdapter, {.functions = std::byte{}}};
  EXPECT_EQ(problem_of_opening().code, ErrorCode::kUnsupported);
}

// As the board that it is not. Boards: tests/kernel.

Problem problem_of_meeting(const std::string& address) {
  const auto port = open_usb_stream(address);
  EXPECT_FALSE(port);
  return port ? Problem{} : port.error();
}

TEST_F(UsbAdapterBench, IsNoSerialPort) {
  const Plugged adapter{bench_, kAdapter};
  const auto problem = problem_of_meeting("0403:C631");
  EXPECT_EQ(problem.code, ErrorCode::kUnsupported);
  EXPECT_EQ(problem.where, "usb:0403:C631");
  EXPECT_THAT(problem.hint, HasSubstr("serial:VID:PID"));
  EXPECT_TRUE(opened()) << "it is left as it was";
}

TEST_F(UsbAdapterBench, AmongSeveralDevicesANumberOrAPlaceChooses) {
  const Plugged adapter{bench_, kAdapter};
  const Plugged twin{bench_, kTwinAdapter};
  const auto problem = problem_of_meeting("0403:c631");
  EXPECT_EQ(problem.code, ErrorCode::kBadTarget);
  EXPECT_THAT(problem.hint, AllOf(HasSubstr("'7A' at 1-2"), HasSubstr("'7B' at 1-3")));
  for (const auto* one : {"0403:c631:7B", "1-3", "1-2,9600"}) {
    EXPECT_EQ(problem_of_meeting(one).code, ErrorCode::kUnsupported) << one;
  }
  for (const auto* none : {"0403:c631:7C", "1-4", "2-3", "1-2.1", "0403:6001"}) {
    EXPECT_EQ(problem_of_meeting(none).code, ErrorCode::kNotFound) << none;
  }
}

TEST_F(UsbAdapterBench, ARequestThatItStallsIsUnsupported) {
  Plugged adapter{bench_, kAdapter};
  const auto port = opened();
  ASSERT_TRUE(port);
  adapter.device().end_transfers_with(EPIPE);
  EXPECT_EQ(error_of_poke(*port), ErrorCode::kUnsupported);
  adapter.device().end_transfers_with(0);
  EXPECT_EQ(poke(*port, kNode), Transfer::kDone);
}

TEST_F(UsbAdapterBench, PulledOutBetweenTransfersItIsDisconnected) {
  Plugged adapter{bench_, kAdapter};
  const auto port = opened();
  ASSERT_TRUE(port);
  adapter.device().pull_out();
  EXPECT_EQ(error_of_poke(*port), ErrorCode::kDisconnected);
  EXPECT_EQ(problem_of_opening().code, ErrorCode::kNotFound);
}

TEST_F(UsbAdapterBench, PulledOutDuringATransferItIsDisconnected) {
  Plugged adapter{bench_, kAdapter};
  const auto port = opened();
  ASSERT_TRUE(port);
  // The host notices the silence of the device first, its hub that it is gone a moment later.
  for (const int error : {EPROTO, ESHUTDOWN}) {
    adapter.device().end_transfers_with(error);
    EXPECT_EQ(error_of_poke(*port), ErrorCode::kDisconnected) << error;
  }
}

TEST_F(UsbAdapterBench, ATransferThatDoesNotEndIsTakenBack) {
  Plugged adapter{bench_, kAdapter};
  const auto port = opened();
  ASSERT_TRUE(port);
  adapter.device().fall_silent();
  EXPECT_EQ(error_of_poke(*port), ErrorCode::kTimedOut);
}

}  // namespace
}  // namespace armjig::testing
