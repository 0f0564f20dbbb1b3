// SPDX-License-Identifier: Apache-2.0
#include "harness/foreign/usb_transfers.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace armjig {
namespace {

// The header of an event, in the order of bytes of the machine that captured it.
constexpr std::uint16_t kShortLink = 189;
constexpr std::uint16_t kLongLink = 220;
constexpr std::size_t kShortHeader = 48;
constexpr std::size_t kLongHeader = 64;
constexpr std::size_t kTypeAt = 8;
constexpr std::size_t kTransferAt = 9;
constexpr std::size_t kEndpointAt = 10;
constexpr std::size_t kDeviceAt = 11;
constexpr std::size_t kBusAt = 12;
constexpr std::size_t kLengthAt = 32;
constexpr std::uint64_t kBulk = 3;
constexpr std::uint64_t kFromDevice = 0x80;

std::uint64_t number(Bytes in, std::size_t at, std::size_t size, bool is_little_endian) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const auto byte = in[at + (is_little_endian ? size - 1 - i : i)];
    value = value << 8U | std::to_integer<std::uint64_t>(byte);
  }
  return value;
}

}  // namespace

bool is_usb_link(std::uint16_t link_type) noexcept {
  return link_type == kShortLink || link_type == kLongLink;
}

struct UsbTransfers::Event {
  Instant time;
  Transfer transfer;
  std::uint64_t length{};  ///< of what went, of an event that completes
  Bytes data;

  [[nodiscard]] bool is_from_device() const noexcept {
    return (std::get<3>(transfer) & kFromDevice) != 0;
  }
};

void UsbTransfers::take(const pcapng::Packet& packet, const pcapng::Interface& interface) {
  const auto header = interface.link_type == kShortLink ? kShortHeader : kLongHeader;
  if (packet.data.size() < header) {
    ++malformed_;
    return;
  }
  const auto get = [&](std::size_t where, std::size_t size) {
    return number(packet.data, where, size, interface.is_little_endian);
  };
  if (get(kTransferAt, 1) != kBulk) return;
  Event event{.time = at(Duration{packet.time_ns}),
              .transfer = {get(0, 8), static_cast<std::uint32_t>(get(kBusAt, 2)),
                           static_cast<std::uint32_t>(get(kDeviceAt, 1)),
                           static_cast<std::uint32_t>(get(kEndpointAt, 1))},
              .length = get(kLengthAt, 4),
              .data = packet.data.subspan(header)};
  const auto type = static_cast<char>(get(kTypeAt, 1));
  if (type == 'C') return complete(event);
  if (type == 'E') submitted_.erase(event.transfer);  // it was refused
  if (type != 'S' || event.is_from_device()) return;
  constexpr std::size_t kMostSubmitted = 256;
  if (submitted_.size() >= kMostSubmitted) submitted_.erase(submitted_.begin());
  submitted_[event.transfer].assign(event.data.begin(), event.data.end());
}

void UsbTransfers::complete(const Event& event) {
  if (event.is_from_device()) {
    const auto size = std::min<std::uint64_t>(event.length, event.data.size());
    return pass(event, Direction::kFromDevice, event.data.first(size), event.length - size);
  }
  const auto submitted = submitted_.extract(event.transfer);
  const auto bytes = submitted.empty() ? Bytes{} : Bytes{submitted.mapped()};
  const auto size = std::min<std::uint64_t>(event.length, bytes.size());
  pass(event, Direction::kToDevice, bytes.first(size), event.length - size);
}

/// `lost` is what of it was not captured, after the bytes.
void UsbTransfers::pass(const Event& event, Direction direction, Bytes bytes, std::uint64_t lost) {
  auto& candidate = candidate_of(event);
  if (candidate.is == UsbCandidate::Is::kOther) {
    other_bytes_ += bytes.size();
    return;
  }
  if (!bytes.empty()) {
    found_.add(event.time, candidate, direction, bytes, {});
    look_at(candidate, direction, bytes);
  }
  if (lost > 0) found_.add(event.time, candidate, direction, {}, lost_details(lost));
}

UsbCandidate& UsbTransfers::candidate_of(const Event& event) {
  constexpr std::size_t kMostCandidates = 1024;
  const std::pair place{std::get<1>(event.transfer), std::get<2>(event.transfer)};
  const auto known = candidates_.find(place);
  if (known != candidates_.end()) return known->second;
  static UsbCandidate nobody{.is = UsbCandidate::Is::kOther};
  if (candidates_.size() >= kMostCandidates) return nobody;
  auto& candidate = candidates_[place];
  candidate.link = &links_.emplace_back(CaptureLink{"usb", "usb", LinkKind::kStream});
  const bool is_elsewhere =
      how_.usb && (how_.usb->bus != place.first || how_.usb->device != place.second);
  for (const auto& device : how_.devices) {
    if (!device.is_usb || is_elsewhere) continue;
    if (how_.usb) {
      links_.back() = {device.name, device.name, LinkKind::kStream};
      candidate.is = UsbCandidate::Is::kWanted;
      return candidate;
    }
    candidate.dissectors.push_back(device.make_dissector());
  }
  if (candidate.dissectors.empty()) candidate.is = UsbCandidate::Is::kOther;
  return candidate;
}

/// The first device in whose words something is said is it.
void UsbTransfers::look_at(UsbCandidate& candidate, Direction direction, Bytes bytes) {
  constexpr std::size_t kMostBytes = std::size_t{64} << 10U;
  if (candidate.is != UsbCandidate::Is::kUnknown) return;
  candidate.bytes += bytes.size();
  std::size_t number = 0;
  for (const auto& device : how_.devices) {
    if (!device.is_usb) continue;
    std::vector<Message> messages;
    candidate.dissectors[number++]->feed(direction, {}, bytes, messages);
    const bool is_it =
        std::ranges::any_of(messages, [](const Message& one) { return one.fault.empty(); });
    if (!is_it) continue;
    const auto wanted = std::ranges::count_if(candidates_, [&device](const auto& one) {
      return one.second.is == UsbCandidate::Is::kWanted && one.second.link->device == device.name;
    });
    const auto link = std::ranges::find_if(
        links_, [&candidate](const CaptureLink& one) { return &one == candidate.link; });
    link->device = device.name;
    link->name = wanted == 0 ? device.name : fmt::format("{}#{}", device.name, wanted + 1);
    candidate.is = UsbCandidate::Is::kWanted;
    break;
  }
  if (candidate.is == UsbCandidate::Is::kUnknown && candidate.bytes > kMostBytes) {
    candidate.is = UsbCandidate::Is::kOther;
    other_bytes_ += candidate.bytes;
  }
  if (candidate.is != UsbCandidate::Is::kUnknown) candidate.dissectors.clear();
}

void UsbTransfers::finish() {
  for (auto& [place, candidate] : candidates_) {
    if (candidate.is != UsbCandidate::Is::kUnknown) continue;
    candidate.is = UsbCandidate::Is::kOther;
    other_bytes_ += candidate.bytes;
  }
}

std::string UsbTransfers::warning(const std::string& name) const {
  std::string text;
  if (other_bytes_ > 0) {
    text = fmt::format(
        "{}: {} bytes of bulk transfers were passed over: of other devices; --usb BUS.DEVICE "
        "chooses one",
        name, other_bytes_);
  }
  if (malformed_ == 0) return text;
  if (!text.empty()) text += '\n';
  return text + fmt::format("{}: {} packets are too short for an event of USB", name, malformed_);
}

}  // namespace armjig
