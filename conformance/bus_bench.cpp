// SPDX-License-Identifier: Apache-2.0
#include "conformance/bus_bench.hpp"

#include <fmt/core.h>

#include <utility>

namespace armjig {
namespace {

constexpr std::size_t kRemembered = 6;

std::byte head_of(BusAddress address, BusPort::Access access) {
  const auto direction = access == BusPort::Access::kRead ? 1U : 0U;
  return static_cast<std::byte>(std::uint32_t{address.value} << 1U | direction);
}

}  // namespace

BusBench::BusBench(BusRig rig, const DissectorEntry& device)
    : rig_{std::move(rig)}, dissector_{device.make()} {}

template <class T>
std::optional<T> BusBench::taken(Result<T> result) {
  if (result) return *result;
  if (result.error().code == ErrorCode::kForbidden) {
    const auto refusal = rig_.last_refusal();
    skip(refusal ? refusal->reason : "the guard does not allow it");
  } else {
    error_ = result.error();
  }
  return std::nullopt;
}
template std::optional<std::byte> BusBench::taken(Result<std::byte> result);

bool BusBench::connect(BusAddress address, BusPort::Access access) {
  return taken(rig_.port().start(address, access)) == Ack::kAck;
}

void BusBench::finish(End end) {
  if (error_ || end == End::kOpen) return;
  if (const auto stopped = rig_.port().stop(); !stopped) error_ = stopped.error();
}

BusBench::Written BusBench::write(BusAddress address, Bytes bytes, End end) {
  Written written;
  if (is_deaf()) return written;
  if (is_whole_only()) return write_whole(address, bytes, end);
  written.is_addressed = connect(address, BusPort::Access::kWrite);
  if (written.is_addressed) {
    for (const auto byte : bytes) {
      if (error_) return written;
      if (taken(rig_.port().write(byte)) != Ack::kAck) ++written.refused;
    }
    remember(head_of(address, BusPort::Access::kWrite), bytes);
  }
  finish(end);
  return written;
}

std::optional<std::vector<std::byte>> BusBench::read(BusAddress address, std::size_t size,
                                                     End end) {
  if (is_deaf()) return std::nullopt;
  if (is_whole_only()) return read_whole(address, size);
  const bool is_addressed = connect(address, BusPort::Access::kRead);
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; is_addressed && i < size && !error_; ++i) {
    const auto byte = taken(rig_.port().read(i + 1 < size ? Ack::kAck : Ack::kNack));
    bytes.push_back(byte.value_or(std::byte{}));
  }
  finish(end);
  if (!is_addressed || error_) return std::nullopt;
  remember(head_of(address, BusPort::Access::kRead), bytes);
  return bytes;
}

std::optional<Transfer> BusBench::transfer(const BusMessage& last) {
  std::vector<BusMessage> messages;
  for (const auto& open : open_) messages.push_back(write_to(open.address, open.bytes));
  messages.push_back(last);
  const auto done = taken(rig_.port().transfer(messages));
  open_.clear();
  return done;
}

BusBench::Written BusBench::write_whole(BusAddress address, Bytes bytes, End end) {
  remember(head_of(address, BusPort::Access::kWrite), bytes);
  if (end == End::kOpen) {
    open_.push_back({address, {bytes.begin(), bytes.end()}});
    return {.is_addressed = true};
  }
  const auto done = transfer(write_to(address, bytes));
  if (!done || *done == Transfer::kAddressRefused) return {};
  return {.is_addressed = true, .refused = *done == Transfer::kByteRefused ? 1U : 0U};
}

std::optional<std::vector<std::byte>> BusBench::read_whole(BusAddress address, std::size_t size) {
  std::vector<std::byte> bytes(size);
  if (transfer(read_from(address, bytes)) != Transfer::kDone) return std::nullopt;
  remember(head_of(address, BusPort::Access::kRead), bytes);
  return bytes;
}

void BusBench::pause(Duration duration) { pause_until(now() + duration); }

void BusBench::pause_until(Instant time) {
  if (!is_deaf()) rig_.port().wait_until(time);
}

void BusBench::touch(std::string_view input, std::int64_t value) {
  if (is_deaf() || rig_.port().touch(input, value)) return;
  skip(fmt::format("needs a hand at the device, to set {}", input));
}

void BusBench::remember(std::byte head, Bytes bytes) {
  std::vector<std::byte> transaction{head};
  transaction.insert(transaction.end(), bytes.begin(), bytes.end());
  std::vector<Message> messages;
  dissector_->feed(Direction::kToDevice, now(), transaction, messages);
  for (auto& message : messages) exchange_.push_back(std::move(message));
  while (exchange_.size() > kRemembered) exchange_.pop_front();
}

std::string BusBench::last_exchange() const {
  std::string text;
  for (const auto& message : exchange_) {
    text += fmt::format("{:.3f} ms {}", static_cast<double>(microseconds(message.time)) / 1000.0,
                        to_text(message));
  }
  return text;
}

}  // namespace armjig
