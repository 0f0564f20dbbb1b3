// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "harness/capture/capture_formats.hpp"
#include "harness/foreign/foreign.hpp"

namespace armjig {

[[nodiscard]] std::unique_ptr<PacketDecoder> make_foreign_decoder(const ForeignHow& how);

/// Whether a place on a bus is a device that is looked for.
struct UsbCandidate {
  enum class Is : std::uint8_t { kUnknown, kWanted, kOther };
  Is is{};
  std::vector<std::unique_ptr<Dissector>> dissectors;  ///< of the devices that it may be
  std::size_t bytes = 0;                               ///< that were looked at
  const CaptureLink* link{};
};

/// Records in order, held back while nobody knows whose they are. Memory has an end: then they are
/// nobody's.
class FoundRecords {
 public:
  /// `details` as in a record.
  void add(Instant time, const CaptureLink& link, Direction direction, std::uint32_t id,
           Bytes bytes, std::string details = {});
  void add_event(Instant time, const CaptureLink& link, std::string details);
  /// Of a device on a bus, whose link is the candidate's when it is known.
  void add(Instant time, UsbCandidate& candidate, Direction direction, Bytes bytes,
           std::string details);
  [[nodiscard]] bool next(CaptureRecord& record);

 private:
  struct Found {
    CaptureRecord record;
    std::vector<std::byte> bytes;
    std::string details;
    UsbCandidate* candidate{};  ///< none: it is known
  };
  std::deque<Found> found_;
  Found given_;
  std::size_t bytes_ = 0;
};

/// The words of `lost_before`; empty if nothing is lost.
[[nodiscard]] std::string lost_details(std::uint64_t lost);

}  // namespace armjig
