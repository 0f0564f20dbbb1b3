// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "harness/capture/capture.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// A record that outlives its reader.
struct KeptRecord {
  Instant time{};
  LinkKind kind{};
  Direction direction{};
  std::uint32_t id{};
  std::vector<std::byte> bytes{};
  std::string details{};

  [[nodiscard]] static KeptRecord from(const CaptureRecord& record) {
    return {record.time,
            record.link->kind,
            record.direction,
            record.id,
            {record.bytes.begin(), record.bytes.end()},
            std::string{record.details}};
  }
  /// Valid as long as this and the link.
  [[nodiscard]] CaptureRecord on(const CaptureLink& link) const {
    return {time, &link, direction, id, bytes, details};
  }

  friend bool operator==(const KeptRecord&, const KeptRecord&) = default;
};

/// A member of an event, which is JSON; empty, or `otherwise`, if there is no such one.
[[nodiscard]] std::string text_in(std::string_view event, const char* key);
[[nodiscard]] double real_in(std::string_view event, const char* key, double otherwise);
/// Rounded, if it is not whole.
[[nodiscard]] std::int64_t number_in(std::string_view event, const char* key,
                                     std::int64_t otherwise);

/// The same of a record's details.
[[nodiscard]] std::string text_in(const KeptRecord& record, const char* key);
[[nodiscard]] std::int64_t number_in(const KeptRecord& record, const char* key,
                                     std::int64_t otherwise);
/// What an event is: `dir`, or `op` of a bus; empty if neither is said.
[[nodiscard]] std::string what_of(const KeptRecord& event);
/// `what_of` an event, the kind of link of anything else.
[[nodiscard]] std::string label_of(const KeptRecord& record);
/// Of a part of a bus transaction: whether it was the last one.
[[nodiscard]] bool has_stop(const KeptRecord& record);

}  // namespace armjig
