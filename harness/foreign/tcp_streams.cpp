// SPDX-License-Identifier: Apache-2.0
#include "harness/foreign/tcp_streams.hpp"

#include <fmt/core.h>
#include <tins/tcp_ip/data_tracker.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <utility>

namespace armjig {
namespace {

using tl::unexpected;

/// Link types, as tcpdump.org lists them.
enum Link : std::uint16_t {
  kNull = 0,  // the family of addresses in four bytes
  kEthernet = 1,
  kRawOfBsd = 12,
  kRaw = 101,
  kLoop = 108,
  kCooked = 113,
  kIpv4 = 228,
  kIpv6 = 229,
  kCooked2 = 276,
};

enum Flag : std::uint8_t { kFin = 1, kSyn = 2, kReset = 4, kAck = 16 };

constexpr std::uint8_t kTcp = 6;

std::uint16_t u16(Bytes in, std::size_t at) { return load_u16_be(in.subspan(at).first<2>()); }

std::uint32_t u32(Bytes in, std::size_t at) {
  return std::uint32_t{u16(in, at)} << 16U | u16(in, at + 2);
}

std::uint8_t u8(Bytes in, std::size_t at) { return std::to_integer<std::uint8_t>(in[at]); }

std::string address_of(Bytes ip, Bytes port) {
  return fmt::format("{}{}", as_text(ip), as_text(port));
}

/// A packet of IP, and whether there is one.
using Inner = tl::expected<Bytes, NotTcp>;

Inner after(Bytes packet, std::size_t size) {
  if (packet.size() < size) return unexpected{NotTcp::kMalformed};
  return packet.subspan(size);
}

Inner behind_ethertype(Bytes packet, std::size_t type_at, std::size_t header) {
  constexpr std::array<std::uint16_t, 3> kTags{0x8100, 0x88A8, 0x9100};
  constexpr std::size_t kTagBytes = 4;
  if (packet.size() < header) return unexpected{NotTcp::kMalformed};
  auto type = u16(packet, type_at);
  while (std::ranges::find(kTags, type) != kTags.end()) {
    if (packet.size() < header + kTagBytes) return unexpected{NotTcp::kMalformed};
    type = u16(packet, header + 2);
    header += kTagBytes;
  }
  const bool is_ip = type == 0x0800 || type == 0x86DD;
  if (!is_ip) return unexpected{NotTcp::kOther};
  return packet.subspan(header);
}

Inner find_ip(std::uint16_t link_type, Bytes packet) {
  switch (link_type) {
    case kEthernet:
      return behind_ethertype(packet, 12, 14);
    case kCooked:
      return behind_ethertype(packet, 14, 16);
    case kCooked2:
      return behind_ethertype(packet, 0, 20);
    case kNull:
    case kLoop:
      return after(packet, 4);
    default:
      return packet;
  }
}

struct Ip {
  Bytes source;
  Bytes destination;
  Bytes payload;
};

tl::expected<Ip, NotTcp> parse_ipv4(Bytes packet) {
  constexpr std::size_t kHeader = 20;
  constexpr std::uint16_t kFragmentBits = 0x3FFF;
  if (packet.size() < kHeader) return unexpected{NotTcp::kMalformed};
  const std::size_t header = std::size_t{u8(packet, 0) & 0x0FU} * 4;
  if (u8(packet, 9) != kTcp) return unexpected{NotTcp::kOther};
  if (header < kHeader || packet.size() < header) return unexpected{NotTcp::kMalformed};
  if ((u16(packet, 6) & kFragmentBits) != 0) return unexpected{NotTcp::kFragment};
  std::size_t size = u16(packet, 2);
  if (size == 0) size = packet.size();  // cut into packets by the network card
  if (size < header) return unexpected{NotTcp::kMalformed};
  return Ip{packet.subspan(12, 4), packet.subspan(16, 4),
            packet.first(std::min(size, packet.size())).subspan(header)};
}

tl::expected<Ip, NotTcp> parse_ipv6(Bytes packet) {
  constexpr std::size_t kHeader = 40;
  enum Next : std::uint8_t { kHops = 0, kRouting = 43, kFragment = 44, kOptions = 60 };
  if (packet.size() < kHeader) return unexpected{NotTcp::kMalformed};
  Ip ip{packet.subspan(8, 16), packet.subspan(24, 16), packet.subspan(kHeader)};
  const std::size_t size = u16(packet, 4);
  if (size > 0) ip.payload = ip.payload.first(std::min(size, ip.payload.size()));
  auto next = u8(packet, 6);
  while (next == kHops || next == kRouting || next == kOptions) {
    if (ip.payload.size() < 8) return unexpected{NotTcp::kMalformed};
    const std::size_t length = (std::size_t{u8(ip.payload, 1)} + 1) * 8;
    next = u8(ip.payload, 0);
    if (ip.payload.size() < length) return unexpected{NotTcp::kMalformed};
    ip.payload = ip.payload.subspan(length);
  }
  if (next == kFragment) return unexpected{NotTcp::kFragment};
  if (next != kTcp) return unexpected{NotTcp::kOther};
  return ip;
}

std::int64_t distance(std::uint32_t from, std::uint32_t to) {
  return static_cast<std::int32_t>(to - from);
}

}  // namespace

bool is_ip_link(std::uint16_t link_type) noexcept {
  constexpr std::array<std::uint16_t, 9> kLinks{kNull,   kEthernet, kRawOfBsd, kRaw,    kLoop,
                                                kCooked, kIpv4,     kIpv6,     kCooked2};
  return std::ranges::find(kLinks, link_type) != kLinks.end();
}

tl::expected<TcpSegment, NotTcp> parse_tcp(std::uint16_t link_type, Bytes packet) {
  constexpr std::size_t kHeader = 20;
  const auto inner = find_ip(link_type, packet);
  if (!inner) return unexpected{inner.error()};
  if (inner->empty()) return unexpected{NotTcp::kMalformed};
  const auto version = u8(*inner, 0) >> 4U;
  if (version != 4 && version != 6) return unexpected{NotTcp::kOther};
  const auto ip = version == 4 ? parse_ipv4(*inner) : parse_ipv6(*inner);
  if (!ip) return unexpected{ip.error()};
  const auto tcp = ip->payload;
  if (tcp.size() < kHeader) return unexpected{NotTcp::kMalformed};
  const std::size_t header = std::size_t{u8(tcp, 12)} / 16 * 4;
  if (header < kHeader || tcp.size() < header) return unexpected{NotTcp::kMalformed};
  return TcpSegment{.source = address_of(ip->source, tcp.first(2)),
                    .destination = address_of(ip->destination, tcp.subspan(2, 2)),
                    .source_port = u16(tcp, 0),
                    .destination_port = u16(tcp, 2),
                    .sequence = u32(tcp, 4),
                    .acknowledged = u32(tcp, 8),
                    .flags = u8(tcp, 13),
                    .payload = tcp.subspan(header)};
}

/// One direction of a connection.
struct TcpStreams::Half {
  std::optional<Tins::TCPIP::DataTracker> tracker;  ///< none: nothing was seen yet
  std::optional<std::uint32_t> first;               ///< the number of the SYN
  bool has_end = false;
  std::uint64_t lost = 0;  ///< before what comes next
  int acknowledged = 0;    ///< so many packets ago the other end had what is missing here
  Instant since{};         ///< of the first of them
};

struct TcpStreams::Talk {
  const CaptureLink* link{};
  std::uint32_t number{};
  std::array<Half, 2> halves;
  bool has_ended = false;
  std::uint64_t last_used = 0;

  [[nodiscard]] Half& of(Direction direction) {
    return halves[direction == Direction::kToDevice ? 0 : 1];
  }
};

TcpStreams::TcpStreams(const ForeignHow& how, FoundRecords& found)
    : how_{how}, found_{found}, connections_(how.devices.size()) {}

TcpStreams::~TcpStreams() = default;

void TcpStreams::take(const pcapng::Packet& packet, const pcapng::Interface& interface) {
  ++packets_;
  now_ = std::max(now_, at(Duration{packet.time_ns}));
  const auto segment = parse_tcp(interface.link_type, packet.data);
  if (!segment) {
    malformed_ += segment.error() == NotTcp::kMalformed ? 1 : 0;
    fragments_ += segment.error() == NotTcp::kFragment ? 1 : 0;
    return;
  }
  auto port = std::ranges::find(how_.ports, segment->destination_port, &ForeignPort::port);
  auto direction = Direction::kToDevice;
  if (port == how_.ports.end()) {
    port = std::ranges::find(how_.ports, segment->source_port, &ForeignPort::port);
    direction = Direction::kFromDevice;
  }
  if (port == how_.ports.end()) {
    ++other_ports_;
  } else if (auto* const talk = talk_of(*segment, direction, port->device)) {
    take(*talk, direction, *segment);
  }
}

/// The connection; nullptr if the segment begins none.
TcpStreams::Talk* TcpStreams::talk_of(const TcpSegment& segment, Direction direction,
                                      std::size_t device) {
  constexpr std::size_t kMostTalks = 256;
  const bool is_to_device = direction == Direction::kToDevice;
  const bool is_client_syn = is_to_device && (segment.flags & (kSyn | kAck)) == kSyn;
  const auto key =
      is_to_device ? segment.source + segment.destination : segment.destination + segment.source;
  const auto found = talks_.find(key);
  if (found != talks_.end()) {
    const bool is_again = found->second->of(direction).first == segment.sequence;
    found->second->last_used = packets_;
    if (!is_client_syn || is_again) return found->second.get();
    drain(*found->second);
    talks_.erase(found);
  } else if (!is_client_syn && segment.payload.empty()) {
    return nullptr;
  }
  if (talks_.size() >= kMostTalks) {
    const auto oldest = std::ranges::min_element(
        talks_, {}, [](const auto& entry) { return entry.second->last_used; });
    drain(*oldest->second);
    talks_.erase(oldest);
  }
  const auto& foreign = how_.devices[device];
  const auto number = connections_[device]++;
  auto name = foreign.name;
  if (foreign.kind == LinkKind::kStream && number > 0) name += fmt::format("#{}", number + 1);
  auto link = std::ranges::find(links_, name, &CaptureLink::name);
  if (link == links_.end()) {
    links_.push_back({name, foreign.name, foreign.kind});
    link = links_.end() - 1;
  }
  auto talk = std::make_unique<Talk>();
  talk->link = &*link;
  talk->number = number;
  talk->last_used = packets_;
  event(*talk, "connect", is_client_syn ? "ok" : "begun before the recording");
  return (talks_[key] = std::move(talk)).get();
}

void TcpStreams::take(Talk& talk, Direction direction, const TcpSegment& segment) {
  constexpr std::uint32_t kMostBuffered = std::uint32_t{256} << 10U;
  auto& half = talk.of(direction);
  auto sequence = segment.sequence;
  if ((segment.flags & kSyn) != 0) {
    half.first = sequence++;
    if (!half.tracker) half.tracker.emplace(sequence);
  }
  if ((segment.flags & kReset) != 0) return end(talk, "reset");
  if (!half.tracker && !segment.payload.empty()) half.tracker.emplace(sequence);
  const auto opposite =
      direction == Direction::kToDevice ? Direction::kFromDevice : Direction::kToDevice;
  if ((segment.flags & kAck) != 0) take_acknowledged(talk, opposite, segment.acknowledged);
  if (!half.tracker) return;
  if (!segment.payload.empty()) {
    const auto* const begin = reinterpret_cast<const std::uint8_t*>(segment.payload.data());
    half.tracker->process_payload(sequence, {begin, begin + segment.payload.size()});
    deliver(talk, direction);
    give_up_gaps(talk, direction, kMostBuffered);
  }
  if ((segment.flags & kFin) != 0 && !half.has_end) {
    half.has_end = true;
    if (!talk.has_ended) {
      event(talk, "disconnect",
            direction == Direction::kToDevice ? "client-half-close" : "device-eof");
    }
  }
}

/// What the other end has got and is not here was not captured, unless packets are only a little
/// out of order.
void TcpStreams::take_acknowledged(Talk& talk, Direction direction, std::uint32_t acknowledged) {
  constexpr std::int64_t kMostAhead = std::int64_t{16} << 20U;
  constexpr int kPatience = 8;
  constexpr auto kMostTime = std::chrono::milliseconds{200};
  auto& half = talk.of(direction);
  if (!half.tracker) return;
  const auto missing = distance(half.tracker->sequence_number(), acknowledged);
  const bool is_end_alone = missing == 1 && half.has_end;  // which has a number, too
  if (missing <= 0 || missing > kMostAhead || is_end_alone) {
    half.acknowledged = 0;
    return;
  }
  if (half.acknowledged++ == 0) half.since = now_;
  if (half.acknowledged <= kPatience && now_ - half.since < kMostTime) return;
  half.acknowledged = 0;
  if (!half.tracker->buffered_payload().empty()) {
    give_up_gap(half);
  } else {
    half.lost += static_cast<std::uint64_t>(missing);
    lost_ += static_cast<std::uint64_t>(missing);
    half.tracker->advance_sequence(acknowledged);
  }
  deliver(talk, direction);
}

/// Goes on with the next bytes that are there.
void TcpStreams::give_up_gap(Half& half) {
  auto& tracker = *half.tracker;
  const auto& buffered = tracker.buffered_payload();
  if (buffered.empty()) return;
  const auto now = tracker.sequence_number();
  const auto next = std::ranges::min_element(
      buffered, {}, [now](const auto& piece) { return distance(now, piece.first); });
  const auto sequence = next->first;
  const auto bytes = next->second;
  const auto missing = distance(now, sequence);
  if (missing > 0) {
    half.lost += static_cast<std::uint64_t>(missing);
    lost_ += static_cast<std::uint64_t>(missing);
    tracker.advance_sequence(sequence);
  }
  tracker.process_payload(sequence, bytes);
}

void TcpStreams::deliver(Talk& talk, Direction direction) {
  auto& half = talk.of(direction);
  auto& payload = half.tracker->payload();
  if (payload.empty()) return;
  const auto id = talk.link->kind == LinkKind::kSession ? talk.number : 0;
  found_.add(now_, *talk.link, direction, id, std::as_bytes(std::span{payload}),
             lost_details(std::exchange(half.lost, 0)));
  payload.clear();
}

void TcpStreams::end(Talk& talk, std::string_view how) {
  drain(talk);
  if (!std::exchange(talk.has_ended, true)) event(talk, "disconnect", how);
}

/// Until no more than so much waits for what is missing.
void TcpStreams::give_up_gaps(Talk& talk, Direction direction, std::uint32_t most) {
  auto& half = talk.of(direction);
  if (!half.tracker) return;
  const auto& tracker = *half.tracker;
  while (!tracker.buffered_payload().empty() && tracker.total_buffered_bytes() > most) {
    const auto before = tracker.buffered_payload().size();
    give_up_gap(half);
    deliver(talk, direction);
    if (tracker.buffered_payload().size() >= before) break;
  }
}

/// All that is left, with its gaps.
void TcpStreams::drain(Talk& talk) {
  for (const auto direction : {Direction::kToDevice, Direction::kFromDevice}) {
    give_up_gaps(talk, direction, 0);
  }
}

void TcpStreams::event(const Talk& talk, std::string_view what, std::string_view text) {
  const auto& device = talk.link->device;
  auto link = std::ranges::find_if(links_, [&device](const CaptureLink& one) {
    return one.kind == LinkKind::kEvents && one.device == device;
  });
  if (link == links_.end()) {
    links_.push_back({device, device, LinkKind::kEvents});
    link = links_.end() - 1;
  }
  found_.add_event(now_, *link,
                   fmt::format(R"("dir":"{}","conn":{},"text":"{}")", what, talk.number, text));
}

void TcpStreams::finish() {
  for (const auto& [key, talk] : talks_) drain(*talk);
}

std::string TcpStreams::warning(const std::string& name) const {
  std::string text;
  const auto add = [&](std::uint64_t count, std::string_view what) {
    if (count == 0) return;
    if (!text.empty()) text += '\n';
    text += fmt::format("{}: {} {}", name, count, what);
  };
  add(lost_, "bytes of TCP were not captured; records that follow a gap say so");
  add(other_ports_, "packets of TCP were passed over: of other ports; --tcp-port names more");
  add(fragments_, "fragments of IP were passed over");
  add(malformed_, "packets were passed over: too short for what they claim");
  return text;
}

}  // namespace armjig
