// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <tuple>

#include "harness/capture/pcapng.hpp"
#include "harness/foreign/foreign_decoder.hpp"

namespace armjig {

/// Whether packets are events of Linux' usbmon.
[[nodiscard]] bool is_usb_link(std::uint16_t link_type) noexcept;

/// What passed in bulk transfers. A transfer to a device has its bytes when it is submitted and
/// counts when it is complete, with as many of them as went; one from it has them then. Others,
/// and empty ones, say nothing.
class UsbTransfers {
 public:
  /// Both are the caller's.
  UsbTransfers(const ForeignHow& how, FoundRecords& found) : how_{how}, found_{found} {}

  void take(const pcapng::Packet& packet, const pcapng::Interface& interface);
  void finish();
  [[nodiscard]] std::string warning(const std::string& name) const;

 private:
  struct Event;
  /// Identifier, bus, device, endpoint.
  using Transfer = std::tuple<std::uint64_t, std::uint32_t, std::uint32_t, std::uint32_t>;

  void complete(const Event& event);
  void pass(const Event& event, Direction direction, Bytes bytes, std::uint64_t lost);
  [[nodiscard]] UsbCandidate& candidate_of(const Event& event);
  void look_at(UsbCandidate& candidate, Direction direction, Bytes bytes);

  const ForeignHow& how_;
  FoundRecords& found_;
  std::map<Transfer, std::vector<std::byte>> submitted_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, UsbCandidate> candidates_;
  std::deque<CaptureLink> links_;
  std::uint64_t malformed_ = 0;
  std::uint64_t other_bytes_ = 0;
};

}  // namespace armjig
