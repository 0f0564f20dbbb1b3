// SPDX-License-Identifier: Apache-2.0
// Recordings as pcapng files: how links, records and headers become interfaces, packets and
// comments, and back. docs/captures.md has the layout.
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "harness/capture/capture_formats.hpp"
#include "harness/capture/pcapng.hpp"
#include "harness/core/nesting.hpp"
#include "harness/core/version.hpp"

namespace armjig {
namespace {

using Json = nlohmann::ordered_json;
using pcapng::Flow;

/// What precedes the bytes of a packet of `kLinkUpperPdu`: tags, each with a type and a length.
enum Tag : std::uint16_t {
  kEndOfTags = 0,
  kDissectorName = 12,
  kPortType = 24,
  kSourcePort = 25,
  kDestinationPort = 26,
};
constexpr std::uint8_t kTcpPorts = 2;

/// Wireshark has a dissector of that name.
constexpr std::string_view kJson = "json";
/// A packet that begins so says what is known of the next one on that link.
constexpr std::string_view kDetailsOf = R"({"armjig.of":)";

constexpr std::size_t kBusHeaderBytes = 6;  // bus, flags, address
constexpr std::size_t kCanHeaderBytes = 8;  // identifier, length, reserved
constexpr std::uint32_t kExtendedCan = 0x8000'0000;
constexpr std::uint32_t kLastShortCanId = 0x7FF;

void put(std::vector<std::byte>& out, std::uint64_t value, std::size_t size) {
  for (auto i = size; i-- > 0;) out.push_back(static_cast<std::byte>(value >> 8 * i));
}

void put(std::vector<std::byte>& out, Bytes bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

Bytes bytes_of(std::string_view text) { return std::as_bytes(std::span{text}); }

std::uint32_t u32(Bytes in) {
  return std::uint32_t{load_u16_be(in.first<2>())} << 16U | load_u16_be(in.subspan(2).first<2>());
}

void put_name(std::vector<std::byte>& out, std::string_view name) {
  put(out, kDissectorName, 2);
  const auto padding = (4 - name.size() % 4) % 4;
  put(out, name.size() + padding, 2);
  put(out, bytes_of(name));
  out.resize(out.size() + padding);
}

std::string interface_name(const CaptureLink& link) {
  const bool is_own = link.kind != LinkKind::kEvents && link.kind != LinkKind::kCan;
  return is_own ? link.name : fmt::format("{} {}", link.name, to_string(link.kind));
}

class PacketCaptureWriter final : public CaptureWriter {
 public:
  Outcome<void> begin(const CaptureHeader& header, std::string& out) override {
    epoch_ns_ = header.epoch_ns;
    links_.clear();
    pcapng::append_section(out, fmt::format("armjig {}", kVersion), header.json);
    (void)interface_of({header.device, header.device, LinkKind::kEvents}, out);
    return {};
  }

  Outcome<void> add(const CaptureRecord& record, std::span<const Message> /*messages*/,
                    std::string& out) override {
    constexpr std::size_t kMostBytes = pcapng::kMostPacketBytes - 1024;
    std::int64_t time_ns = 0;
    const auto& link = *record.link;
    if (__builtin_add_overflow(record.time.time_since_epoch().count(), epoch_ns_, &time_ns)) {
      return problem(ErrorCode::kUnsupported, link.name, "a time is too late for pcapng");
    }
    const bool can_be_cut = link.kind == LinkKind::kStream || link.kind == LinkKind::kSession;
    if (record.details.size() > kMostBytes || (!can_be_cut && record.bytes.size() > kMostBytes)) {
      return problem(ErrorCode::kUnsupported, link.name,
                     fmt::format("at {} us: Wireshark takes no record that is longer than {} bytes",
                                 microseconds(record.time), kMostBytes));
    }
    packet_ = {};
    packet_.time_ns = time_ns;
    if (link.kind == LinkKind::kEvents) {
      add_json(link, fmt::format("{{{}}}", record.details), out);
      return {};
    }
    if (!record.details.empty()) {
      add_json(
          {link.name, link.device, LinkKind::kEvents},
          fmt::format("{}{},{}}}", kDetailsOf, json_string(interface_name(link)), record.details),
          out);
    }
    auto rest = record.bytes;
    do {
      const auto piece = rest.first(std::min(rest.size(), kMostBytes));
      add_bytes(record, piece, out);
      rest = rest.subspan(piece.size());
    } while (!rest.empty());
    return {};
  }

 private:
  void add_json(const CaptureLink& link, const std::string& text, std::string& out) {
    data_.clear();
    put_name(data_, kJson);
    put(data_, kEndOfTags, 4);
    put(data_, bytes_of(text));
    packet_.flow = Flow::kUnknown;
    add_packet(link, out);
  }

  void add_bytes(const CaptureRecord& record, Bytes bytes, std::string& out) {
    const auto& link = *record.link;
    const bool is_to_device = record.direction == Direction::kToDevice;
    data_.clear();
    if (link.kind == LinkKind::kBus) {
      put(data_, 0, kBusHeaderBytes - 1);
      put(data_, record.id << 1U | (is_to_device ? 0U : 1U), 1);
    } else if (link.kind == LinkKind::kCan) {
      put(data_, record.id | (record.id > kLastShortCanId ? kExtendedCan : 0), 4);
      put(data_, bytes.size(), 1);
      put(data_, 0, 3);
    } else {
      put_name(data_, link.device);
      if (link.kind == LinkKind::kSession) put_ports(record.id, is_to_device);
      put(data_, kEndOfTags, 4);
    }
    put(data_, bytes);
    packet_.flow = is_to_device ? Flow::kOutbound : Flow::kInbound;
    add_packet(link, out);
  }

  /// The number of the connection stands where the client's port would.
  void put_ports(std::uint32_t connection, bool is_to_device) {
    const auto put_tag = [this](Tag tag, std::uint32_t value) {
      put(data_, tag, 2);
      put(data_, 4, 2);
      put(data_, value, 4);
    };
    put_tag(kPortType, kTcpPorts);
    put_tag(is_to_device ? kSourcePort : kDestinationPort, connection);
    put_tag(is_to_device ? kDestinationPort : kSourcePort, 0);
  }

  void add_packet(const CaptureLink& link, std::string& out) {
    packet_.interface = interface_of(link, out);
    packet_.data = data_;
    packet_.original_size = data_.size();
    pcapng::append_packet(out, packet_);
  }

  /// Its number. One that is new is written.
  std::size_t interface_of(const CaptureLink& link, std::string& out) {
    const auto found = std::ranges::find(links_, link);
    if (found != links_.end()) return static_cast<std::size_t>(found - links_.begin());
    links_.push_back(link);
    pcapng::Interface interface;
    interface.link_type = link.kind == LinkKind::kBus   ? pcapng::kLinkI2c
                          : link.kind == LinkKind::kCan ? pcapng::kLinkCan
                                                        : pcapng::kLinkUpperPdu;
    interface.name = interface_name(link);
    interface.comment =
        fmt::format(R"({{"link":{},"device":{},"kind":"{}"}})", json_string(link.name),
                    json_string(link.device), to_string(link.kind));
    pcapng::append_interface(out, interface);
    return links_.size() - 1;
  }

  std::int64_t epoch_ns_{};
  std::vector<CaptureLink> links_;
  pcapng::Packet packet_;
  std::vector<std::byte> data_;
};

/// The tags of a packet of `kLinkUpperPdu`.
struct UpperPdu {
  std::string_view dissector;
  std::optional<std::uint32_t> source;
  std::optional<std::uint32_t> destination;
  Bytes bytes;
};

std::optional<UpperPdu> parse_upper_pdu(Bytes data) {
  std::optional<UpperPdu> found{std::in_place};  // made where it is used: copies cost more than all
  auto& pdu = *found;
  while (data.size() >= 4) {
    const auto tag = load_u16_be(data.first<2>());
    const std::size_t size = load_u16_be(data.subspan(2).first<2>());
    data = data.subspan(4);
    if (size > data.size()) break;
    const auto value = data.first(size);
    data = data.subspan(size);
    if (tag == kEndOfTags) {
      pdu.bytes = data;
      return found;
    }
    if (tag == kDissectorName) {
      pdu.dissector = as_text(value);
      pdu.dissector = pdu.dissector.substr(0, pdu.dissector.find('\0'));
    }
    if (tag == kSourcePort && size == 4) pdu.source = u32(value);
    if (tag == kDestinationPort && size == 4) pdu.destination = u32(value);
  }
  found.reset();
  return found;
}

class PacketCaptureReader final : public CaptureReader {
 public:
  PacketCaptureReader(std::unique_ptr<pcapng::Source> source,
                      std::unique_ptr<PacketDecoder> decoder, std::string path)
      : reader_{std::move(source)}, decoder_{std::move(decoder)}, path_{std::move(path)} {}

  /// Up to the first packet: only then is known what the header says.
  Outcome<void> read_header() {
    const auto has_packet = reader_->next(packet_);
    if (!has_packet) return tl::unexpected{has_packet.error()};
    has_packet_ = *has_packet;
    auto header = CaptureHeader::parse(reader_->comment(), path_);
    header_ = header ? *std::move(header) : foreign_header();
    return {};
  }

  [[nodiscard]] std::string_view format() const noexcept override { return reader_->format(); }

  Outcome<bool> next(CaptureRecord& record) override {
    while (true) {
      if (std::exchange(is_ahead_, false)) {
        record = ahead_;
        record.time = since_start(ahead_.time);
        return true;
      }
      if (decoder_ && decoder_->next(record)) {
        record.time = since_start(record.time);
        return true;
      }
      if (has_ended_) return end();
      if (!std::exchange(has_packet_, false)) read_packet();
      if (!has_ended_ && !decode_packet() && take(record)) return true;
      has_packet_ = false;
    }
  }

  [[nodiscard]] std::string warning() const override {
    auto text = reader_->warning();
    const auto add = [&text](const std::string& line) {
      if (!text.empty() && !line.empty()) text += '\n';
      text += line;
    };
    if (decoder_) add(decoder_->warning(path_));
    if (not_understood_ > 0) {
      add(fmt::format("{}: {} packets were passed over: of no link that is known here", path_,
                      not_understood_));
    }
    return text;
  }

 private:
  void read_packet() {
    auto has_packet = reader_->next(packet_);
    if (!has_packet) problem_ = std::move(has_packet.error());
    has_ended_ = !has_packet || !*has_packet;
    if (has_ended_ && decoder_) decoder_->finish();
  }

  Outcome<bool> end() const {
    if (problem_) return tl::unexpected{*problem_};
    return false;
  }

  /// Whether the packet is the decoder's.
  bool decode_packet() {
    const auto& interface = reader_->interfaces()[packet_.interface];
    if (!decoder_ || !decoder_->knows(interface.link_type)) return false;
    decoder_->take(packet_, interface);
    return true;
  }

  /// The device of the first record, if it is the decoder who finds it.
  std::string device_ahead() {
    while (has_packet_ && decode_packet()) {
      is_ahead_ = decoder_->next(ahead_);
      has_packet_ = false;
      if (is_ahead_) break;
      read_packet();
      has_packet_ = !has_ended_;
    }
    if (!is_ahead_ && has_ended_ && decoder_) is_ahead_ = decoder_->next(ahead_);
    return is_ahead_ ? ahead_.link->device : std::string{};
  }

  /// What the interfaces say, for a file that somebody else wrote, or put together.
  CaptureHeader foreign_header() {
    CaptureHeader header;
    header.epoch_ns = std::max(std::int64_t{0}, packet_.time_ns);
    for (std::size_t i = 0; i < reader_->interfaces().size() && header.device.empty(); ++i) {
      const bool is_bus = reader_->interfaces()[i].link_type == pcapng::kLinkI2c;
      header.device = own_link_of(i).device;
      if (header.device.empty() && is_bus && decoder_) header.device = decoder_->bus_device();
    }
    if (const auto ahead = device_ahead(); header.device.empty()) header.device = ahead;
    if (header.device.empty()) header.device = "unknown";
    Json json{{"format", "golden-trace/1"}, {"device", header.device}};
    if (header.epoch_ns > 0) json["epoch_ns"] = header.epoch_ns;
    header.json = json.dump();
    return header;
  }

  /// As the comment of the interface has it; the name is empty if it has nothing.
  [[nodiscard]] CaptureLink own_link_of(std::size_t interface) const {
    const auto& comment = reader_->interfaces()[interface].comment;
    if (is_too_deep(comment)) return {};
    const auto json = Json::parse(comment, nullptr, /*allow_exceptions=*/false);
    const auto text = [&json](const char* key) {
      const auto found = json.find(key);
      return found != json.end() && found->is_string() ? found->get<std::string>() : std::string{};
    };
    if (!json.is_object()) return {};
    const auto kind = text("kind");
    for (const auto each : {LinkKind::kStream, LinkKind::kSession, LinkKind::kBus, LinkKind::kCan,
                            LinkKind::kEvents}) {
      if (kind == to_string(each)) return {text("link"), text("device"), each};
    }
    return {};
  }

  /// The link of an interface that nobody describes, by its first packet.
  [[nodiscard]] CaptureLink guessed_link(const pcapng::Interface& interface,
                                         const std::optional<UpperPdu>& pdu) const {
    CaptureLink link{interface.name, header_.device, LinkKind::kStream};
    if (interface.link_type == pcapng::kLinkI2c) {
      link.kind = LinkKind::kBus;
      if (decoder_ && !decoder_->bus_device().empty()) link.device = decoder_->bus_device();
    }
    if (interface.link_type == pcapng::kLinkCan) link.kind = LinkKind::kCan;
    if (pdu) {
      link.device = pdu->dissector;
      if (pdu->source) link.kind = LinkKind::kSession;
      if (pdu->dissector == kJson) link = {header_.device, header_.device, LinkKind::kEvents};
    }
    if (link.name.empty()) link.name = link.device;
    return link;
  }

  const CaptureLink& link_of_packet(const std::optional<UpperPdu>& pdu) {
    if (links_.size() <= packet_.interface) links_.resize(packet_.interface + 1);
    auto& known = links_[packet_.interface];
    if (known == nullptr) {
      auto own = own_link_of(packet_.interface);
      if (own.name.empty()) own = guessed_link(reader_->interfaces()[packet_.interface], pdu);
      known = &link(own.name, own.device, own.kind);
    }
    return *known;
  }

  /// Whether the packet is a record.
  bool take(CaptureRecord& record) {
    const auto type = reader_->interfaces()[packet_.interface].link_type;
    const auto pdu =
        type == pcapng::kLinkUpperPdu ? parse_upper_pdu(packet_.data) : std::optional<UpperPdu>{};
    const bool is_known = pdu ||
                          (type == pcapng::kLinkI2c && packet_.data.size() >= kBusHeaderBytes) ||
                          (type == pcapng::kLinkCan && packet_.data.size() >= kCanHeaderBytes);
    if (!is_known) return pass_over();
    // What happened on a bus beside its transfers, as the format has it.
    constexpr std::byte kBusEvent{0x80};
    const bool is_bus = type == pcapng::kLinkI2c;
    if (is_bus && (packet_.data.front() & kBusEvent) != std::byte{}) return false;
    const auto& link = link_of_packet(pdu);
    record = {};
    record.time = time_of_packet();
    record.link = &link;
    record.direction =
        packet_.flow == Flow::kInbound ? Direction::kFromDevice : Direction::kToDevice;
    if (pdu && link.kind == LinkKind::kEvents) return take_event(record, as_text(pdu->bytes));
    if (pdu) {
      // Copying both halves of `pdu->bytes`, which were just written, would stall the processor.
      record.bytes = packet_.data.last(pdu->bytes.size());
      const bool is_to_device = record.direction == Direction::kToDevice;
      record.id = (is_to_device ? pdu->source : pdu->destination).value_or(0);
    } else if (type == pcapng::kLinkI2c) {
      take_transfer(record);
    } else {
      record.id = u32(packet_.data) & kLastCanId;
      record.bytes = packet_.data.subspan(kCanHeaderBytes);
      const auto size = std::to_integer<std::size_t>(packet_.data[4]);
      if (size < record.bytes.size()) record.bytes = record.bytes.first(size);
    }
    if (has_details_ && details_time_ == packet_.time_ns &&
        details_of_ == reader_->interfaces()[packet_.interface].name) {
      has_details_ = false;
      record.details = details_;
    }
    return true;
  }

  void take_transfer(CaptureRecord& record) {
    const auto address = std::to_integer<std::uint32_t>(packet_.data[kBusHeaderBytes - 1]);
    record.direction = (address & 1U) != 0 ? Direction::kFromDevice : Direction::kToDevice;
    record.id = address >> 1U;
    record.bytes = packet_.data.subspan(kBusHeaderBytes);
  }

  /// Whether it is an event of its own; else it is kept for the record that it belongs to.
  bool take_event(CaptureRecord& record, std::string_view text) {
    if (is_too_deep(text)) return pass_over();
    const auto json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
    const bool is_line =
        text.starts_with('{') && text.ends_with('}') && text.find('\n') == std::string_view::npos;
    if (!json.is_object() || !is_line) return pass_over();
    const auto members = text.substr(1, text.size() - 2);
    if (!text.starts_with(kDetailsOf)) {
      record.details = members;
      const bool is_event = text.starts_with(R"({"dir":")") || text.starts_with(R"({"op":")") ||
                            text.starts_with(R"({"t_ms":)");
      return is_event || pass_over();
    }
    const auto name = json.begin()->is_string() ? json.begin()->get<std::string>() : std::string{};
    const auto comma = kDetailsOf.size() + json_string(name).size();
    if (comma >= text.size() || text[comma] != ',') return pass_over();
    if (has_details_) ++not_understood_;  // those before belong to nothing
    has_details_ = true;
    details_ = text.substr(comma + 1, text.size() - comma - 2);
    details_of_ = name;
    details_time_ = packet_.time_ns;
    return false;
  }

  bool pass_over() {
    ++not_understood_;
    return false;
  }

  Instant time_of_packet() { return since_start(at(Duration{packet_.time_ns})); }

  Instant since_start(Instant time) {
    std::int64_t since = 0;
    if (__builtin_sub_overflow(time.time_since_epoch().count(), header_.epoch_ns, &since)) {
      since = 0;
    }
    last_ = std::max(last_, at(Duration{since}));
    return last_;
  }

  std::unique_ptr<pcapng::Source> reader_;
  std::unique_ptr<PacketDecoder> decoder_;  ///< none: other link types are passed over
  CaptureRecord ahead_;                     ///< read for the header
  bool is_ahead_ = false;
  bool has_ended_ = false;
  std::optional<Problem> problem_;
  std::string path_;
  pcapng::Packet packet_;
  bool has_packet_ = false;
  std::vector<const CaptureLink*> links_;  ///< of the interfaces
  Instant last_{};
  std::uint64_t not_understood_ = 0;
  bool has_details_ = false;
  std::string details_;
  std::string details_of_;  ///< the name of the interface
  std::int64_t details_time_{};
};

}  // namespace

Outcome<std::unique_ptr<CaptureReader>> open_packets(UserFile file, const std::string& path) {
  return open_packets(std::make_unique<pcapng::Reader>(std::move(file), path), nullptr, path);
}

Outcome<std::unique_ptr<CaptureReader>> open_packets(std::unique_ptr<pcapng::Source> source,
                                                     std::unique_ptr<PacketDecoder> decoder,
                                                     const std::string& path) {
  auto reader = std::make_unique<PacketCaptureReader>(std::move(source), std::move(decoder), path);
  auto begun = reader->read_header();
  if (!begun) return tl::unexpected{std::move(begun.error())};
  return reader;
}

std::unique_ptr<CaptureWriter> make_packet_writer() {
  return std::make_unique<PacketCaptureWriter>();
}

}  // namespace armjig
