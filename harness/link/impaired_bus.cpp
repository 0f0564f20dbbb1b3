// SPDX-License-Identifier: Apache-2.0
#include "harness/link/impaired_bus.hpp"

#include <array>
#include <cassert>
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
    : inner_{std::move(inner)}, paths_{impairment} {
  assert(inner_ != nullptr);
}

Result<Ack> ImpairedBus::start(BusAddress address, Access access) {
  const auto byte = static_cast<std::byte>(address.value << 1 | (access == Access::kRead ? 1 : 0));
  is_missed_ = carry(paths_.out, byte) != byte;
  if (is_missed_) return missed();
  is_started_ = true;
  return inner_->start(address, access);
}

Result<Ack> ImpairedBus::write(std::byte byte) {
  const auto carried = is_missed_ ? std::nullopt : carry(paths_.out, byte);
  return carried ? inner_->write(*carried) : missed();
}

Result<std::byte> ImpairedBus::read(Ack reply) {
  if (is_missed_ || is_gone()) {
    std::ignore = missed();
    return kIdle;
  }
  const auto byte = inner_->read(reply);
  return byte ? carry(paths_.in, *byte).value_or(kIdle) : byte;
}

Result<void> ImpairedBus::stop() {
  is_missed_ = false;
  return std::exchange(is_started_, false) ? inner_->stop() : Result<void>{};
}

bool ImpairedBus::is_gone() const noexcept {
  const auto is_broken = [](const ImpairedPath& path) {
    return path.end(Instant::max()) == ImpairedPath::End::kBroken;
  };
  return is_broken(paths_.out) || is_broken(paths_.in);
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
