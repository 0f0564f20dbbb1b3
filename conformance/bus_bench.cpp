// SPDX-License-Identifier: Apache-2.0
#include "conformance/bus_bench.hpp"

#include <utility>

namespace armjig {
namespace {

std::byte head_of(BusAddress address, BusPort::Access access) {
  const auto direction = access == BusPort::Access::kRead ? 1U : 0U;
  return static_cast<std::byte>(std::uint32_t{address.value} << 1U | direction);
}

}  // namespace

BusBench::BusBench(Rig<BusPort> rig, std::unique_ptr<Dissector> dissector)
    : DissectedBench{std::move(rig), std::move(dissector), 6} {}

bool BusBench::connect(BusAddress address, BusPort::Access access) {
  return taken(port().start(address, access)) == Ack::kAck;
}

void BusBench::finish(End end) {
  if (error() || end == End::kOpen) return;
  if (const auto stopped = port().stop(); !stopped) lose_link(stopped.error());
}

BusBench::Written BusBench::write(BusAddress address, Bytes bytes, End end) {
  Written written;
  if (is_deaf()) return written;
  if (is_whole_only()) return write_whole(address, bytes, end);
  written.is_addressed = connect(address, BusPort::Access::kWrite);
  if (written.is_addressed) {
    for (const auto byte : bytes) {
      if (error()) return written;
      if (taken(port().write(byte)) != Ack::kAck) ++written.refused;
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
  for (std::size_t i = 0; is_addressed && i < size && !error(); ++i) {
    const auto byte = taken(port().read(i + 1 < size ? Ack::kAck : Ack::kNack));
    bytes.push_back(byte.value_or(std::byte{}));
  }
  finish(end);
  if (!is_addressed || error()) return std::nullopt;
  remember(head_of(address, BusPort::Access::kRead), bytes);
  return bytes;
}

std::optional<Transfer> BusBench::transfer(const BusMessage& last) {
  std::vector<BusMessage> messages;
  for (const auto& open : open_) messages.push_back(write_to(open.address, open.bytes));
  messages.push_back(last);
  const auto done = taken(port().transfer(messages));
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
  if (!is_deaf()) port().wait_until(time);
}

void BusBench::remember(std::byte head, Bytes bytes) {
  std::vector<std::byte> transaction{head};
  transaction.insert(transaction.end(), bytes.begin(), bytes.end());
  (void)dissect(Direction::kToDevice, transaction);
}

}  // namespace armjig
