// SPDX-License-Identifier: Apache-2.0
#include "emulators/usb/tiny_usb.hpp"

#include <utility>

namespace armjig::usb {
namespace {

constexpr ClassCode kOfVendor{0xFF, 0x00, 0x00};
constexpr std::uint8_t kSlowPacket = 8;  // of a low-speed device

// Requests, as the kernel's driver i2c-tiny-usb sends them. A message has the address as its index
// and the kernel's read flag as its value.
constexpr std::uint8_t kVendorKind = 0x40;
constexpr std::uint8_t kKindBits = 0x60;
constexpr std::uint8_t kEcho = 0;
constexpr std::uint8_t kTellFunctions = 1;
constexpr std::uint8_t kSetDelay = 2;
constexpr std::uint8_t kTellStatus = 3;
constexpr std::uint8_t kMessage = 4;
constexpr std::uint8_t kWithStart = 1;  // begins a transaction; without it a start is repeated
constexpr std::uint8_t kWithStop = 2;
constexpr std::uint16_t kReadFlag = 1;
constexpr std::uint16_t kAddressBits = 0x7F;

// I2C_FUNC_I2C (1) and what Linux makes of plain messages: SMBus quick, byte, byte data, word data,
// process call, and writing blocks (bits 16 to 23, 25, 26 and 27).
constexpr std::uint32_t kFunctions = 0x0EFF'0001;

std::vector<std::byte> little_endian(std::uint32_t value, std::size_t size) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::byte>(value >> 8 * i));
  return bytes;
}

Description describe_adapter(Identity identity) {
  identity.vendor = TinyUsb::kVendor;
  identity.product = TinyUsb::kProduct;
  return {.identity = std::move(identity),
          .speed = Speed::kLow,
          .code = kOfVendor,
          .control_packet_size = kSlowPacket,
          .interfaces = {{kOfVendor, {}, {}}}};
}

}  // namespace

TinyUsb::TinyUsb(Identity identity, BusPort& bus)
    : description_{describe_adapter(std::move(identity))}, bus_{bus} {}

std::optional<ControlReply> TinyUsb::control(Instant time, const Setup& setup, Bytes bytes) {
  if ((setup.type & kKindBits) != kVendorKind) return std::nullopt;
  bus_.wait_until(time);
  switch (setup.request) {
    case kEcho:
      return ControlReply{little_endian(setup.value, 2)};
    case kTellFunctions:
      return ControlReply{little_endian(kFunctions, 4)};
    case kSetDelay:  // the emulated bus has its own clock
      return ControlReply{};
    case kTellStatus:
      return ControlReply{little_endian(static_cast<std::uint32_t>(status_), 1)};
    default:
      break;
  }
  if ((setup.request & ~(kWithStart | kWithStop)) != kMessage) return std::nullopt;
  return message(setup, bytes);
}

void TinyUsb::reset(Instant time) {
  bus_.wait_until(time);
  stop();
  status_ = Status::kIdle;
}

/// None: the bus is stuck.
std::optional<ControlReply> TinyUsb::message(const Setup& setup, Bytes bytes) {
  if ((setup.request & kWithStart) != 0) stop();  // one that was left open
  ControlReply reply;
  if ((setup.value & kReadFlag) != 0) reply.bytes.resize(setup.length);
  if (!lead(setup, bytes, reply.bytes)) {
    stop();
    return std::nullopt;
  }
  if ((setup.request & kWithStop) != 0 || status_ == Status::kRefused) stop();
  reply.due = bus_.now();
  return reply;
}

/// False: the bus is stuck.
bool TinyUsb::lead(const Setup& setup, Bytes bytes, std::vector<std::byte>& received) {
  const bool is_read = (setup.value & kReadFlag) != 0;
  const BusAddress address{static_cast<std::uint8_t>(setup.index & kAddressBits)};
  is_in_transaction_ = true;
  const auto ack = bus_.start(address, is_read ? Access::kRead : Access::kWrite);
  if (!ack) return false;
  status_ = *ack == Ack::kAck ? Status::kAcknowledged : Status::kRefused;
  if (status_ == Status::kRefused) return true;
  return is_read ? read_all(received) : write_all(bytes);
}

bool TinyUsb::write_all(Bytes bytes) {
  for (const auto byte : bytes) {
    const auto ack = bus_.write(byte);
    if (!ack) return false;
    if (*ack == Ack::kAck) continue;
    status_ = Status::kRefused;
    return true;
  }
  return true;
}

bool TinyUsb::read_all(std::vector<std::byte>& into) {
  for (std::size_t i = 0; i < into.size(); ++i) {
    const auto byte = bus_.read(i + 1 == into.size() ? Ack::kNack : Ack::kAck);
    if (!byte) return false;
    into[i] = *byte;
  }
  return true;
}

void TinyUsb::stop() {
  if (std::exchange(is_in_transaction_, false)) (void)bus_.stop();
}

}  // namespace armjig::usb
