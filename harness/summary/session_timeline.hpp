// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "harness/capture/capture.hpp"
#include "harness/core/time.hpp"
#include "harness/report/timeline.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// A session over time, gathered message by message in memory that does not grow with it. The
/// longer it gets, the wider are the stretches of its curves, the more marks are one, and the fewer
/// of the messages that no mark needs are kept.
class SessionTimeline {
 public:
  /// `id` as of the record.
  void add(const CaptureLink& link, std::uint32_t id, const Message& message);
  /// A record of `LinkKind::kEvents`.
  void add_event(const CaptureRecord& record);

  [[nodiscard]] Timeline timeline(std::string title, Instant end) const;

 private:
  enum LaneName : std::uint8_t { kCommands, kAnswers, kStates, kEvents, kFindings, kLanes };
  struct Mark {
    Instant begin{};
    Instant end{};
    std::uint64_t count{};
    std::string text;
    TimelineMessage message;
  };
  struct Bin {
    std::int64_t number{};
    double least{};
    double most{};
  };
  struct Curve {
    std::size_t order{};
    std::vector<Bin> bins;
  };
  /// Direction, message, what stands before the last dot of the field, unit.
  using ChartKey = std::tuple<Direction, std::string, std::string, std::string>;
  struct Chart {
    std::size_t order{};
    std::map<std::string, Curve> curves;
  };

  [[nodiscard]] std::string who(const CaptureLink& link, std::uint32_t id);
  [[nodiscard]] TimelineMessage keep(Instant time, std::string direction, std::string text,
                                     bool is_bad);
  void mark(LaneName lane, Instant time, std::string text, const TimelineMessage& message);
  void take_states(const std::string& who, const Message& message, const TimelineMessage& kept);
  void take_curves(const std::string& who, const Message& message);
  void widen();

  std::string first_link_;
  std::uint64_t count_ = 0;
  std::uint64_t every_ = 1;  ///< of so many messages one is kept
  std::vector<TimelineMessage> sample_;
  std::vector<Mark> lanes_[kLanes];
  bool has_merged_ = false;
  std::map<std::pair<std::string, const Field*>, std::int64_t> states_;
  std::map<ChartKey, Chart> charts_;
  std::size_t curves_ = 0;
  Duration width_{1};  ///< of a bin
};

}  // namespace armjig
