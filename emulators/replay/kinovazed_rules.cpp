// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/kinovazed_rules.hpp"

#include <algorithm>
#include <set>
#include <string>

namespace armjig::kinovazed::replay {
namespace {

using Events = std::vector<TraceEvent>;
using Difference = std::optional<TraceDifference>;

std::string_view text_of(const TraceEvent& event) { return as_text(event.bytes); }

bool is_beat(const TraceEvent& event) { return text_of(event).starts_with("Heartbeat:"); }

bool says_the_same(const TraceEvent& a, const TraceEvent& b) {
  return a.dir == b.dir && a.bytes == b.bytes && a.name == b.name;
}

Duration waited(const TraceEvent& event) { return std::chrono::microseconds{event.value}; }

/// What a heartbeat may say (docs/spec/kinovazed.md, "Heartbeats").
constexpr int kBeats[] = {1, 3, 5, 13, 21, 37, 69, 133};

/// One connection, or what belongs to none.
struct Lane {
  Events others;
  Events beats;
};

Lane lane_of(const Events& events, const std::string& dir_of_end, std::uint32_t connection) {
  Lane lane;
  for (const auto& event : events) {
    const bool belongs = (event.dir == "end") == !dir_of_end.empty();
    if (!belongs || (dir_of_end.empty() && event.id != connection)) continue;
    (is_beat(event) ? lane.beats : lane.others).push_back(event);
  }
  return lane;
}

class Comparator {
 public:
  explicit Comparator(const SessionRules& rules) : rules_{rules} {}

  [[nodiscard]] Difference compare(const Lane& recorded, const Lane& actual) const {
    if (auto difference =
            compare_others(recorded.others, in_recorded_order(recorded.others, actual.others))) {
      return difference;
    }
    return compare_beats(recorded, actual);
  }

 private:
  template <std::size_t size>
  static bool is_one_of(const TraceEvent& event, const std::array<std::string_view, size>& texts) {
    return std::ranges::find(texts, text_of(event)) != texts.end();
  }

  /// An event that races its `Accepted` may come on either side of it.
  [[nodiscard]] bool may_swap(const TraceEvent& a, const TraceEvent& b) const {
    const bool is_pair = (text_of(a) == "Accepted\r\n" && is_one_of(b, rules_.racing)) ||
                         (text_of(b) == "Accepted\r\n" && is_one_of(a, rules_.racing));
    return is_pair && b.time - a.time <= rules_.same_time;
  }

  [[nodiscard]] Events in_recorded_order(const Events& recorded, Events actual) const {
    const auto size = std::min(recorded.size(), actual.size());
    for (std::size_t i = 0; i + 1 < size; ++i) {
      const bool is_swapped = says_the_same(recorded[i], actual[i + 1]) &&
                              says_the_same(recorded[i + 1], actual[i]) &&
                              !says_the_same(recorded[i], actual[i]);
      const bool both_may =
          may_swap(recorded[i], recorded[i + 1]) && may_swap(actual[i], actual[i + 1]);
      if (is_swapped && both_may) std::swap(actual[i], actual[i + 1]);
    }
    return actual;
  }

  [[nodiscard]] bool is_in_time(const TraceEvent& recorded, const TraceEvent& actual) const {
    const auto share = [&](double part) {
      return std::chrono::duration_cast<Duration>(waited(recorded) * part);
    };
    const bool is_motion = is_one_of(recorded, rules_.motions);
    const auto late = is_motion ? std::max(rules_.late, share(rules_.motion_late)) : rules_.late;
    const auto early =
        is_motion ? std::max(rules_.early, share(rules_.motion_early)) : rules_.early;
    return waited(actual) <= waited(recorded) + late && waited(actual) >= waited(recorded) - early;
  }

  [[nodiscard]] Difference compare_others(const Events& recorded, const Events& actual) const {
    for (std::size_t i = 0; i < std::max(recorded.size(), actual.size()); ++i) {
      if (i >= actual.size()) return TraceDifference{recorded[i], {}};
      if (i >= recorded.size()) return TraceDifference{{}, actual[i]};
      const bool is_timed = recorded[i].dir == "from_device" || recorded[i].dir == "disconnect";
      if (!says_the_same(recorded[i], actual[i]) ||
          (is_timed && !is_in_time(recorded[i], actual[i]))) {
        return TraceDifference{recorded[i], actual[i]};
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] bool is_near_a_change(const TraceEvent& beat, const Events& messages) const {
    return std::ranges::any_of(messages, [&](const TraceEvent& message) {
      const bool tells = message.dir == "from_device" && text_of(message) != "Rejected\r\n";
      return tells && std::chrono::abs(message.time - beat.time) <= rules_.beat_near;
    });
  }

  /// Whether a message came between the last two beats, or beside them.
  [[nodiscard]] bool is_near_a_change(const Events& beats, const Events& messages) const {
    const auto from = beats[beats.size() - 2].time - rules_.beat_near;
    return std::ranges::any_of(messages, [&](const TraceEvent& message) {
      return message.dir == "from_device" && message.time >= from;
    });
  }

  /// Whether a server can have said the last beat, which the other side does not have: it is one of
  /// those that there are, and that of before unless something has changed.
  [[nodiscard]] bool is_likely(const Events& beats, const Events& messages) const {
    const auto text = text_of(beats.back());
    const bool is_whole = std::ranges::any_of(
        kBeats, [text](int beat) { return text == "Heartbeat:" + std::to_string(beat) + "\r\n"; });
    return is_whole && (beats.size() < 2 || beats.back().bytes == beats[beats.size() - 2].bytes ||
                        is_near_a_change(beats, messages));
  }

  /// The number of beats follows from the time: at the ends of a connection one may be on either
  /// side. The others are exact but near a change of state.
  [[nodiscard]] Difference compare_beats(const Lane& recorded, const Lane& actual) const {
    const auto& wanted = recorded.beats;
    const auto& got = actual.beats;
    if (wanted.size() > got.size() + 1) return TraceDifference{wanted[got.size()], {}};
    if (got.size() > wanted.size() + 1) return TraceDifference{{}, got[wanted.size()]};
    for (std::size_t i = 0; i < std::min(wanted.size(), got.size()); ++i) {
      if (wanted[i].bytes == got[i].bytes) continue;
      const bool may_differ =
          is_near_a_change(wanted[i], recorded.others) || is_near_a_change(got[i], actual.others);
      if (!may_differ) return TraceDifference{wanted[i], got[i]};
    }
    if (wanted.size() > got.size() && !is_likely(wanted, recorded.others)) {
      return TraceDifference{wanted.back(), {}};
    }
    if (got.size() > wanted.size() && !is_likely(got, actual.others)) {
      return TraceDifference{{}, got.back()};
    }
    return std::nullopt;
  }

  const SessionRules& rules_;
};

}  // namespace

Difference session_difference(const Events& recorded, const Events& actual,
                              const SessionRules& rules) {
  std::set<std::uint32_t> connections;
  for (const auto& event : recorded) connections.insert(event.id);
  for (const auto& event : actual) connections.insert(event.id);
  const Comparator comparator{rules};
  for (const auto connection : connections) {
    const auto difference =
        comparator.compare(lane_of(recorded, "", connection), lane_of(actual, "", connection));
    if (difference) return difference;
  }
  return comparator.compare(lane_of(recorded, "end", 0), lane_of(actual, "end", 0));
}

Difference session_difference(const Events& recorded, const Events& actual) {
  return session_difference(recorded, actual, SessionRules{});
}

}  // namespace armjig::kinovazed::replay
