// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "harness/capture/capture.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig::test {

/// A recording that a test writes down.
class ScriptedCapture final : public CaptureReader {
 public:
  explicit ScriptedCapture(LinkKind kind) : link_{&link("link", "", kind)} {}

  void request(Duration time, ByteVector bytes, std::uint32_t id = 0) {
    add(time, Direction::kToDevice, std::move(bytes), id);
  }
  void answer(Duration time, ByteVector bytes, std::uint32_t id = 0) {
    add(time, Direction::kFromDevice, std::move(bytes), id);
  }
  /// Members of records; on a bus acknowledge letters.
  void set_details(std::string details) { entries_.back().details = std::move(details); }

  [[nodiscard]] std::string_view format() const noexcept override { return "scripted"; }
  [[nodiscard]] Outcome<bool> next(CaptureRecord& record) override {
    if (next_ == entries_.size()) return false;
    const auto& entry = entries_[next_++];
    record = {entry.time, link_, entry.direction, entry.id, entry.bytes, entry.details};
    return true;
  }

 private:
  struct Entry {
    Instant time{};
    Direction direction{};
    ByteVector bytes;
    std::uint32_t id{};
    std::string details{};
  };

  void add(Duration time, Direction direction, ByteVector bytes, std::uint32_t id) {
    entries_.push_back({at(time), direction, std::move(bytes), id});
  }

  const CaptureLink* link_;
  std::vector<Entry> entries_;
  std::size_t next_ = 0;
};

inline ByteVector text(std::string_view line) {
  const auto bytes = std::as_bytes(std::span{line});
  return {bytes.begin(), bytes.end()};
}

}  // namespace armjig::test
