// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/morap/master.hpp"

#include <tuple>

namespace armjig::morap::drive {
namespace {

BusCode code_of(Error error, BusCode collision) noexcept {
  switch (error.code) {
    case ErrorCode::kTimedOut:
      return BusCode::kTimedOut;
    case ErrorCode::kDisconnected:
      return BusCode::kGone;
    case ErrorCode::kNotFound:
      return BusCode::kAway;
    case ErrorCode::kForbidden:
      return BusCode::kForbidden;
    default:
      return collision;
  }
}

}  // namespace

std::string_view describe(BusCode code) noexcept {
  switch (code) {
    case BusCode::kOk:
      return "all went well";
    case BusCode::kNoSuchAddress:
      return "nobody acknowledges the address";
    case BusCode::kByteRefused:
      return "a byte was not acknowledged";
    case BusCode::kStartCollision:
      return "the bus is taken or held by another";
    case BusCode::kByteCollision:
      return "another took the bus in the middle of a transaction";
    case BusCode::kTimedOut:
      return "a device holds the clock";
    case BusCode::kGone:
      return "the bus is gone";
    case BusCode::kForbidden:
      return "not allowed by the guard";
    case BusCode::kAway:
      return "the bus is away";
  }
  return {};
}

ErrorCode error_of(BusCode code) noexcept {
  switch (code) {
    case BusCode::kNoSuchAddress:
    case BusCode::kAway:
      return ErrorCode::kNotFound;
    case BusCode::kTimedOut:
      return ErrorCode::kTimedOut;
    case BusCode::kGone:
      return ErrorCode::kDisconnected;
    case BusCode::kForbidden:
      return ErrorCode::kForbidden;
    default:
      return ErrorCode::kBusy;
  }
}

/// Of a bus that does whole transactions only. It ends them at the first byte that is refused.
BusCode Master::transfer(const BusMessage& message) {
  const auto done = port_->transfer({&message, 1});
  if (!done) return code_of(done.error(), BusCode::kByteCollision);
  switch (*done) {
    case Transfer::kDone:
      return BusCode::kOk;
    case Transfer::kAddressRefused:
      return BusCode::kNoSuchAddress;
    case Transfer::kByteRefused:
      break;
  }
  return BusCode::kByteRefused;
}

BusCode Master::transmit(BusAddress address, Bytes data) {
  if (!port_->has_operations()) return transfer(write_to(address, data));
  const auto answer = port_->start(address, BusPort::Access::kWrite);
  if (!answer) return code_of(answer.error(), BusCode::kStartCollision);
  auto code = *answer == Ack::kAck ? BusCode::kOk : BusCode::kNoSuchAddress;
  if (code == BusCode::kNoSuchAddress) data = {};
  for (const auto byte : data) {
    const auto reply = port_->write(byte);
    if (!reply) {
      code = code_of(reply.error(), BusCode::kByteCollision);
      break;
    }
    if (*reply == Ack::kNack) code = BusCode::kByteRefused;
  }
  std::ignore = port_->stop();  // whatever comes of it, the code is decided
  return code;
}

BusCode Master::receive(BusAddress address, std::span<std::byte> out) {
  if (!port_->has_operations()) return transfer(read_from(address, out));
  const auto answer = port_->start(address, BusPort::Access::kRead);
  if (!answer) return code_of(answer.error(), BusCode::kStartCollision);
  auto code = *answer == Ack::kAck ? BusCode::kOk : BusCode::kNoSuchAddress;
  if (code == BusCode::kNoSuchAddress) out = {};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto byte = port_->read(i + 1 < out.size() ? Ack::kAck : Ack::kNack);
    if (!byte) {
      code = code_of(byte.error(), BusCode::kByteCollision);
      break;
    }
    out[i] = *byte;
  }
  std::ignore = port_->stop();
  return code;
}

ScanResult Master::scan() {
  constexpr std::uint8_t kFirst = 0x08;
  constexpr std::uint8_t kLast = 0x77;
  ScanResult result;
  for (auto address = kFirst; address <= kLast; ++address) {
    const auto code = poke({address});
    if (code == BusCode::kOk) result.addresses.push_back({address});
    if (code == BusCode::kOk || code == BusCode::kNoSuchAddress) continue;
    result.code = code;
    break;
  }
  return result;
}

}  // namespace armjig::morap::drive
