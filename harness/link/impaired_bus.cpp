// SPDX-License-Identifier: Apache-2.0
#include "harness/link/impaired_bus.hpp"

#include <array>
#include <deque>
#include <string>
#include <tuple>
#include <utility>

namespace armjig {
namespace {

constexpr Duration kByte = std::chrono::microseconds{90};  // nine clocks at 100 kHz
constexpr std::byte kIdle{0xFF};

/// What is left of an impairment that a bus cannot have.
PathImpairment beyond_a_bus(const PathImpairment& path) {
  PathImpairment rest;
  rest.chunk = path.chunk;
  rest.doubling = path.doubling;
  rest.reordering = path.reordering;
  rest.split = path.split;
  rest.merge = path.merge;
  return rest;
}

std::string named(const Impairment& rest) {
  const auto text = to_string(rest);
  return text.substr(0, text.rfind(','));  // without the seed
}

}  // namespace

Outcome<std::unique_ptr<ImpairedBus>> ImpairedBus::make(std::unique_ptr<BusPort> inner,
                                                        const Impairment& impairment) {
  const Impairment rest{beyond_a_bus(impairment.out), beyond_a_bus(impairment.in), 1};
  if (rest == Impairment{}) {
    return std::unique_ptr<ImpairedBus>{new ImpairedBus{std::move(inner), impairment}};
  }
  return problem(ErrorCode::kUnsupported, "impairment '" + named(rest) + "'",
                 "an I2C bus can have bit-errors, loss, delay, bandwidth, stall, disconnect and "
                 "disconnect-after");
}

ImpairedBus::ImpairedBus(std::unique_ptr<BusPort> inner, const Impairment& impairment)
    : BusAround{std::move(inner)}, paths_{impairment} {}

Result<Transfer> ImpairedBus::transfer(std::span<const BusMessage> messages) {
  if (has_operations()) return BusPort::transfer(messages);
  auto end = Transfer::kDone;
  std::vector<BusMessage> arriving;
  std::deque<std::vector<std::byte>> written;
  for (const auto& message : messages) {
    end = carry(message, written.emplace_back());
    const bool is_begun = end == Transfer::kDone || !written.back().empty();
    if (is_begun)
      arriving.push_back({message.address, message.access, written.back(), message.read});
    if (end != Transfer::kDone) break;
  }
  if (arriving.empty()) return end;
  const auto done = inner().transfer(arriving);
  if (!done || *done != Transfer::kDone) return done;
  for (const auto& message : arriving) {
    for (auto& byte : message.read) byte = carry(paths_.in, byte).value_or(kIdle);
  }
  return end;
}

/// What of a message arrives, and how it ends there.
Transfer ImpairedBus::carry(const BusMessage& message, std::vector<std::byte>& written) {
  if (carry(paths_.out, head_of(message)) != head_of(message)) {
    std::ignore = missed();
    return Transfer::kAddressRefused;
  }
  for (const auto byte : message.write) {
    const auto carried = carry(paths_.out, byte);
    if (!carried) return Transfer::kByteRefused;
    written.push_back(*carried);
  }
  return Transfer::kDone;
}

Result<Ack> ImpairedBus::start(BusAddress address, Access access) {
  const auto byte = head_of({address, access});
  is_missed_ = carry(paths_.out, byte) != byte;
  if (is_missed_) return missed();
  is_started_ = true;
  return inner().start(address, access);
}

Result<Ack> ImpairedBus::write(std::byte byte) {
  const auto carried = is_missed_ ? std::nullopt : carry(paths_.out, byte);
  return carried ? inner().write(*carried) : missed();
}

Result<std::byte> ImpairedBus::read(Ack reply) {
  if (is_missed_ || is_gone()) {
    std::ignore = missed();
    return kIdle;
  }
  const auto byte = inner().read(reply);
  return byte ? carry(paths_.in, *byte).value_or(kIdle) : byte;
}

Result<void> ImpairedBus::stop() {
  is_missed_ = false;
  return std::exchange(is_started_, false) ? inner().stop() : Result<void>{};
}

/// The byte as it arrives, after its delay; nothing if it does not arrive.
std::optional<std::byte> ImpairedBus::carry(ImpairedPath& path, std::byte byte) {
  if (is_gone()) path.close(now());
  path.push(now(), std::array{byte});
  if (const auto due = path.next_due(now())) wait_until(*due);
  const auto delivery = path.pop(Instant::max());
  return delivery ? std::optional{delivery->bytes.front()} : std::nullopt;
}

/// A byte that nobody sees takes its time all the same.
Ack ImpairedBus::missed() {
  wait_until(now() + kByte);
  return Ack::kNack;
}

}  // namespace armjig
