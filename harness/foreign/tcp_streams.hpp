// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <memory>

#include "harness/capture/pcapng.hpp"
#include "harness/foreign/foreign_decoder.hpp"

namespace armjig {

/// Whether packets of that link type can have IP in them.
[[nodiscard]] bool is_ip_link(std::uint16_t link_type) noexcept;

/// One segment of TCP, as it stands in a packet.
struct TcpSegment {
  std::string source;  ///< address and port
  std::string destination;
  std::uint16_t source_port{};
  std::uint16_t destination_port{};
  std::uint32_t sequence{};
  std::uint32_t acknowledged{};
  std::uint8_t flags{};
  Bytes payload;
};

enum class NotTcp : std::uint8_t { kOther, kMalformed, kFragment };

/// What a packet of that link type holds.
[[nodiscard]] tl::expected<TcpSegment, NotTcp> parse_tcp(std::uint16_t link_type, Bytes packet);

/// What was said in connections to known ports. Segments are put in order, what comes twice is
/// taken once; what the other end acknowledged and the file does not have is lost.
class TcpStreams {
 public:
  /// Both are the caller's.
  TcpStreams(const ForeignHow& how, FoundRecords& found);
  TcpStreams(const TcpStreams&) = delete;
  TcpStreams& operator=(const TcpStreams&) = delete;
  ~TcpStreams();

  void take(const pcapng::Packet& packet, const pcapng::Interface& interface);
  void finish();
  [[nodiscard]] std::string warning(const std::string& name) const;

 private:
  struct Half;
  struct Talk;

  [[nodiscard]] Talk* talk_of(const TcpSegment& segment, Direction direction, std::size_t device);
  void take(Talk& talk, Direction direction, const TcpSegment& segment);
  void take_acknowledged(Talk& talk, Direction direction, std::uint32_t acknowledged);
  void give_up_gap(Half& half);
  void give_up_gaps(Talk& talk, Direction direction, std::uint32_t most);
  void deliver(Talk& talk, Direction direction);
  void end(Talk& talk, std::string_view how);
  void drain(Talk& talk);
  void event(const Talk& talk, std::string_view what, std::string_view text);

  const ForeignHow& how_;
  FoundRecords& found_;
  std::map<std::string, std::unique_ptr<Talk>> talks_;  ///< by both ends, the client first
  std::vector<std::uint32_t> connections_;              ///< so far, of each device
  std::deque<CaptureLink> links_;
  Instant now_{};
  std::uint64_t packets_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t other_ports_ = 0;
  std::uint64_t malformed_ = 0;
  std::uint64_t fragments_ = 0;
};

}  // namespace armjig
