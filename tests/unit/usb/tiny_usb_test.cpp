// SPDX-License-Identifier: Apache-2.0
// The adapter's requests as Linux' driver and our own link send them, and two ends of armjig
// together: `make_i2c_tiny_usb` at the host's.
#include "emulators/usb/tiny_usb.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

#include "emulators/i2c/bus.hpp"
#include "emulators/i2c/thermometer.hpp"
#include "emulators/morap/node.hpp"
#include "emulators/usb/device.hpp"
#include "harness/core/hex.hpp"
#include "harness/drive/morap/joint.hpp"
#include "harness/link/emulated_bus_port.hpp"
#include "harness/link/i2c_tiny_usb.hpp"

namespace armjig::usb {
namespace {

constexpr BusAddress kNode{0x12};

class Adapter {
 public:
  Adapter() {
    port.bus().attach(morap::emulation::Node{{.eeprom = morap::emulation::dcx22l()}});
    ask({0x00, 9, 1, 0, 0});
  }

  Completion ask(const Setup& setup, std::vector<std::byte> bytes = {}) {
    const std::uint8_t endpoint = setup.type & kIn;
    device.submit(
        time,
        {.endpoint = endpoint, .setup = setup, .room = setup.length, .bytes = std::move(bytes)});
    time = std::max(time, device.next_due().value_or(time));
    return device.next(time).value_or(Completion{});
  }

  Instant time{};
  EmulatedBusPort<i2c::Bus> port{i2c::Bus{}};
  TinyUsb function{{.serial_number = "7A"}, port};
  Device device{function};
};

/// The host's side of it, as libusb would carry it.
class Cabled final : public UsbControl {
 public:
  explicit Cabled(Adapter& adapter) noexcept : adapter_{adapter} {}

  Result<std::size_t> read(UsbRequest request, std::span<std::byte> into) override {
    const auto end = adapter_.ask({0xC1, request.request, request.value, request.index,
                                   static_cast<std::uint16_t>(into.size())});
    if (end.status != Status::kDone) return fail(ErrorCode::kUnsupported);
    std::ranges::copy(end.bytes, into.begin());
    return end.size;
  }
  Result<std::size_t> write(UsbRequest request, Bytes bytes) override {
    const auto end = adapter_.ask({0x41, request.request, request.value, request.index,
                                   static_cast<std::uint16_t>(bytes.size())},
                                  {bytes.begin(), bytes.end()});
    if (end.status != Status::kDone) return fail(ErrorCode::kUnsupported);
    return end.size;
  }

 private:
  Adapter& adapter_;
};

TEST(TinyUsb, IsTheAdapterThatLinuxKnows) {
  Adapter adapter;
  // Low speed: eight bytes at a time; 0403:c631.
  EXPECT_EQ(to_hex(adapter.ask({0x80, 6, 0x0100, 0, 18}).bytes),
            "12010002ff0000080304"
            "31c6000101020301");
}

TEST(TinyUsb, CarriesWhatADriveSaysAndHears) {
  Adapter adapter;
  const auto port = make_i2c_tiny_usb(std::make_unique<Cabled>(adapter), "i2c-tiny-usb:").value();
  morap::drive::Master master{*port};
  morap::drive::Joint joint{master, kNode};
  EXPECT_EQ(joint.calibrate(morap::drive::Angle{1.0F}), morap::drive::BusCode::kOk);
  // captures/morap: 1 rad is 18840 counts, which read as 0.9999935
  EXPECT_FLOAT_EQ(joint.angle().value.value, 0.9999935F);
}

TEST(TinyUsb, TellsWhoIsNotThere) {
  Adapter adapter;
  const auto port = make_i2c_tiny_usb(std::make_unique<Cabled>(adapter), "i2c-tiny-usb:").value();
  const auto poke = write_to(BusAddress{0x13}, {});
  EXPECT_EQ(port->transfer({&poke, 1}), armjig::Transfer::kAddressRefused);
  const auto node = write_to(kNode, {});
  EXPECT_EQ(port->transfer({&node, 1}), armjig::Transfer::kDone);
}

TEST(TinyUsb, RepeatsTheStartWhereLinuxBeginsOnce) {
  Adapter adapter;
  // The driver of Linux says start with the first message only, stop with the last: chooses the
  // register of the own address (0x88), and reads it.
  EXPECT_EQ(adapter.ask({0x41, 5, 0, 0x12, 1}, from_hex("88").value()).size, 1U);
  EXPECT_EQ(to_hex(adapter.ask({0xC1, 3, 0, 0, 1}).bytes), "01");
  EXPECT_EQ(to_hex(adapter.ask({0xC1, 6, 1, 0x12, 1}).bytes), "12");
}

TEST(TinyUsb, AnswersWhenTheBusHasDoneIt) {
  Adapter adapter;
  const auto start = adapter.time;
  adapter.ask({0x41, 7, 0, 0x12, 1}, from_hex("88").value());
  // Address and a byte, nine bits each, and a start and a stop, at 100 kHz.
  EXPECT_GE(adapter.time - start, std::chrono::microseconds{180});
  EXPECT_LT(adapter.time - start, std::chrono::microseconds{1000});
}

TEST(TinyUsb, LeavesTheBusAloneWhenItIsPulledOutInATransaction) {
  Adapter adapter;
  adapter.ask({0x41, 5, 0, 0x12, 1}, from_hex("88").value());  // no stop
  adapter.device.unplug(adapter.time);
  adapter.ask({0x00, 9, 1, 0, 0});
  EXPECT_EQ(to_hex(adapter.ask({0xC1, 3, 0, 0, 1}).bytes), "00");
  EXPECT_EQ(adapter.ask({0xC1, 7, 1, 0x12, 1}).status, Status::kDone);
}

TEST(TinyUsb, StallsOnWhatItDoesNotKnow) {
  Adapter adapter;
  EXPECT_EQ(adapter.ask({0xC1, 8, 0, 0, 1}).status, Status::kStalled);
  EXPECT_EQ(adapter.ask({0xA1, 1, 0, 0, 4}).status, Status::kStalled);
}

}  // namespace
}  // namespace armjig::usb
