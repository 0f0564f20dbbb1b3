// SPDX-License-Identifier: Apache-2.0
#include "harness/link/bus_port.hpp"

namespace armjig {
namespace {

Result<Transfer> run(BusPort& port, const BusMessage& message) {
  const auto answer = port.start(message.address, message.access);
  if (!answer) return tl::unexpected{answer.error()};
  if (*answer == Ack::kNack) return Transfer::kAddressRefused;
  for (const auto byte : message.write) {
    const auto reply = port.write(byte);
    if (!reply) return tl::unexpected{reply.error()};
    if (*reply == Ack::kNack) return Transfer::kByteRefused;
  }
  for (std::size_t i = 0; i < message.read.size(); ++i) {
    const auto byte = port.read(i + 1 < message.read.size() ? Ack::kAck : Ack::kNack);
    if (!byte) return tl::unexpected{byte.error()};
    message.read[i] = *byte;
  }
  return Transfer::kDone;
}

}  // namespace

Result<Transfer> BusPort::transfer(std::span<const BusMessage> messages) {
  Result<Transfer> result{Transfer::kDone};
  for (const auto& message : messages) {
    result = run(*this, message);
    if (!result || *result != Transfer::kDone) break;
  }
  const auto stopped = stop();
  if (result && !stopped) return tl::unexpected{stopped.error()};
  return result;
}

}  // namespace armjig
