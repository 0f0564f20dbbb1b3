// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "harness/capture/capture.hpp"
#include "harness/core/time.hpp"
#include "harness/timing/latency_histogram.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// The dissector of a device by the name that a recording has for it; nullptr: there is none here.
using FindDissector = std::function<MakeDissector(std::string_view device)>;

/// Hears of each message, with its link and the `id` of the record that ended it.
using HearMessage =
    std::function<void(const CaptureLink& link, std::uint32_t id, const Message& message)>;

/// What a recording shows, gathered record by record in memory that does not grow with it.
class SessionSummary {
 public:
  explicit SessionSummary(FindDissector find_dissector, HearMessage hear = {});
  SessionSummary(const SessionSummary&) = delete;
  SessionSummary& operator=(const SessionSummary&) = delete;
  ~SessionSummary();

  void add(const CaptureRecord& record);
  /// After the last record.
  void finish();

  /// Of the last record.
  [[nodiscard]] Instant end() const noexcept { return end_; }
  /// Whether there were bytes that are no message.
  [[nodiscard]] bool has_findings() const noexcept { return !findings_.empty(); }
  /// For people, a screen of lines.
  [[nodiscard]] std::string to_text() const;
  /// One object without a line end, docs/schemas/session.schema.json ("armjig.session/1").
  [[nodiscard]] std::string to_json() const;

 private:
  struct Talk;
  struct Lane {
    std::uint64_t records{};
    std::uint64_t bytes{};
    std::optional<Instant> first;
    Instant last{};
    Duration longest_gap{};
    Instant gap_begin{};
  };
  struct LinkCount {
    std::string device;
    LinkKind kind{};
    Lane lanes[2];  ///< by direction
    LatencyHistogram round_trips;
  };
  struct MessageCount {
    std::uint64_t count{};
    Instant first{};
    Instant last{};
  };
  /// A number that a device says again and again.
  struct Value {
    const Field* field{};
    std::int64_t first{};
    std::int64_t last{};
    std::int64_t least{};
    std::int64_t most{};
    std::uint64_t changes{};
  };
  struct Change {
    Instant time{};
    std::string text;
  };
  using NameOf = std::pair<Direction, std::string>;

  Talk& talk_of(const CaptureRecord& record);
  void take(const Talk& talk, const Message& message);
  void take_values(const Message& message);
  void take_finding(const Message& message);

  FindDissector find_dissector_;
  HearMessage hear_;
  Instant end_{};
  std::uint64_t records_{};
  std::uint64_t events_{};
  std::map<std::string, LinkCount> links_;
  std::map<std::pair<std::string, std::uint32_t>, std::unique_ptr<Talk>> talks_;
  std::uint64_t conversations_{};
  std::map<NameOf, MessageCount> messages_;
  std::map<std::string, std::uint64_t> findings_;
  std::uint64_t other_findings_{};
  std::map<std::string, Value> values_;
  std::vector<Change> changes_;
  std::uint64_t other_changes_{};
};

}  // namespace armjig
