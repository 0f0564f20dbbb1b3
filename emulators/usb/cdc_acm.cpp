// SPDX-License-Identifier: Apache-2.0
#include "emulators/usb/cdc_acm.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace armjig::usb {
namespace {

constexpr ClassCode kCommunication{0x02, 0x02, 0x01};  // abstract control model, AT commands
constexpr ClassCode kData{0x0A, 0x00, 0x00};
constexpr ClassCode kCommunicationDevice{0x02, 0x00, 0x00};

// Requests to the interface (PSTN, table 13).
constexpr std::uint8_t kClassToPort = 0x21;
constexpr std::uint8_t kClassFromPort = 0xA1;
constexpr std::uint8_t kSetLineCoding = 0x20;
constexpr std::uint8_t kGetLineCoding = 0x21;
constexpr std::uint8_t kSetControlLineState = 0x22;
constexpr std::uint8_t kSendBreak = 0x23;
constexpr std::uint16_t kDataTerminalReady = 1;
constexpr std::size_t kLineCodingSize = 7;

// A notification (PSTN, table 31): carrier and data set ready are on while a program is there.
constexpr std::uint8_t kSerialState = 0x20;
constexpr std::uint8_t kCarrierAndReady = 0x03;

template <std::size_t n>
std::vector<std::byte> bytes_of(const std::array<std::uint8_t, n>& values) {
  std::vector<std::byte> bytes;
  for (const auto value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

/// Functional descriptors (CDC 1.2, 5.2.3): header, call management (none), which requests it knows
/// (line coding, line state, break), and that interface 1 belongs to interface 0.
std::vector<std::byte> functional_descriptors() {
  constexpr std::uint8_t kClassInterface = 0x24;
  return bytes_of(std::array<std::uint8_t, 19>{5, kClassInterface, 0x00, 0x10, 0x01,  //
                                               5, kClassInterface, 0x01, 0x00, 0x01,  //
                                               4, kClassInterface, 0x02, 0x06,        //
                                               5, kClassInterface, 0x06, 0x00, 0x01});
}

Description describe_port(Identity identity) {
  const Endpoint notifications{CdcAcm::kNotifications, Endpoint::Kind::kInterrupt, 16, 16};
  const Endpoint out{CdcAcm::kBulkOut, Endpoint::Kind::kBulk, CdcAcm::kPacketSize, 0};
  const Endpoint in{CdcAcm::kBulkIn, Endpoint::Kind::kBulk, CdcAcm::kPacketSize, 0};
  return {.identity = std::move(identity),
          .code = kCommunicationDevice,
          .interfaces = {{kCommunication, functional_descriptors(), {notifications}},
                         {kData, {}, {out, in}}}};
}

}  // namespace

CdcAcm::CdcAcm(Identity identity, Events events)
    : description_{describe_port(std::move(identity))}, events_{std::move(events)} {}

bool CdcAcm::send(Bytes message) {
  assert(!message.empty());
  if (!is_open_ || waiting_ + message.size() > kCapacity) return false;
  waiting_ += message.size();
  for (; message.size() >= kPacketSize; message = message.subspan(kPacketSize)) {
    packets_.emplace_back(message.begin(), message.begin() + kPacketSize);
  }
  packets_.emplace_back(message.begin(), message.end());  // the short one, at least empty
  return true;
}

std::optional<ControlReply> CdcAcm::control(Instant /*time*/, const Setup& setup, Bytes bytes) {
  if (setup.type == kClassFromPort && setup.request == kGetLineCoding) return line_coding_reply();
  if (setup.type != kClassToPort) return std::nullopt;
  switch (setup.request) {
    case kSetLineCoding:
      return set_line_coding(bytes);
    case kSetControlLineState:
      set_open((setup.value & kDataTerminalReady) != 0);
      return ControlReply{};
    case kSendBreak:  // a board on USB has no line on which it could be seen
      return ControlReply{};
    default:
      return std::nullopt;
  }
}

bool CdcAcm::take(std::uint8_t /*endpoint*/, Bytes packet) {
  if (packet.empty()) return true;
  if (!events_.wants_bytes()) return false;
  events_.on_bytes(packet);
  return true;
}

std::optional<std::vector<std::byte>> CdcAcm::give(std::uint8_t endpoint) {
  auto& queue = endpoint == kNotifications ? notifications_ : packets_;
  if (queue.empty()) return std::nullopt;
  auto packet = std::move(queue.front());
  queue.pop_front();
  if (endpoint == kBulkIn) waiting_ -= packet.size();
  return packet;
}

void CdcAcm::reset(Instant /*time*/) {
  set_open(false);
  notifications_.clear();
  coding_ = {};
}

std::optional<ControlReply> CdcAcm::set_line_coding(Bytes bytes) {
  if (bytes.size() != kLineCodingSize) return std::nullopt;
  const auto at = [bytes](std::size_t i) { return std::to_integer<std::uint8_t>(bytes[i]); };
  coding_.baud = 0;
  for (std::size_t i = 4; i-- > 0;) coding_.baud = coding_.baud << 8U | at(i);
  coding_.stop_bits = at(4);
  coding_.parity = at(5);
  coding_.data_bits = at(6);
  return ControlReply{};
}

ControlReply CdcAcm::line_coding_reply() const {
  std::array<std::uint8_t, kLineCodingSize> values{};
  for (std::size_t i = 0; i < 4; ++i) values[i] = static_cast<std::uint8_t>(coding_.baud >> 8 * i);
  values[4] = coding_.stop_bits;
  values[5] = coding_.parity;
  values[6] = coding_.data_bits;
  return {.bytes = bytes_of(values)};
}

void CdcAcm::set_open(bool is_open) {
  if (is_open == std::exchange(is_open_, is_open)) return;
  packets_.clear();  // nothing is left for the next program
  waiting_ = 0;
  const auto state = is_open ? kCarrierAndReady : std::uint8_t{0};
  notifications_.assign(1, bytes_of(std::array<std::uint8_t, 10>{kClassFromPort, kSerialState, 0, 0,
                                                                 0, 0, 2, 0, state, 0}));
  events_.on_open(is_open);
}

}  // namespace armjig::usb
