// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/morap/master.hpp"

#include <tuple>

namespace armjig::morap {
namespace {

BusCode code_of(Error error, BusCode collision) noexcept {
  return error.code == ErrorCode::kTimedOut ? BusCode::kTimedOut : collision;
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
  }
  return {};
}

BusCode Master::transmit(BusAddress address, Bytes data) {
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

std::vector<BusAddress> Master::scan() {
  constexpr std::uint8_t kFirst = 0x08;
  constexpr std::uint8_t kLast = 0x77;
  std::vector<BusAddress> found;
  for (auto address = kFirst; address <= kLast; ++address) {
    if (poke({address}) == BusCode::kOk) found.push_back({address});
  }
  return found;
}

}  // namespace armjig::morap
