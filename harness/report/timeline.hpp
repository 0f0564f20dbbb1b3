// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace armjig {

/// What one stretch of a curve came to. Both ends are drawn, so no peak is lost.
struct TimelineStretch {
  double seconds{};
  double least{};
  double most{};
};

struct TimelineCurve {
  std::string name{};
  std::vector<TimelineStretch> stretches{};  ///< in order of time
};

/// Curves of one unit.
struct TimelineChart {
  std::string title{};
  std::vector<TimelineCurve> curves{};
};

/// Something that happened at a time, or went on for one.
struct TimelineMark {
  double begin{};  ///< in seconds
  double end{};
  std::string text{};
  std::uint64_t message{};  ///< the number of the one that says so
};

struct TimelineLane {
  std::string title{};
  bool is_bad = false;  ///< what is on it is wrong
  std::vector<TimelineMark> marks{};
};

struct TimelineMessage {
  std::uint64_t number{};
  double seconds{};
  std::string direction{};
  std::string text{};
  bool is_bad = false;
};

/// A session over time: curves and lanes, and messages below them. Only the page has it.
struct Timeline {
  std::string title{};
  double seconds{};
  std::vector<TimelineChart> charts{};
  std::vector<TimelineLane> lanes{};
  std::vector<TimelineMessage>
      messages{};          ///< in order of number; those that marks name among them
  std::string left_out{};  ///< a sentence; empty: nothing
};

/// As a `<figure>` of HTML for our page, whose script zooms it and links marks and messages both
/// ways; without the script, marks are links to their messages.
[[nodiscard]] std::string to_figure(const Timeline& timeline);

}  // namespace armjig
