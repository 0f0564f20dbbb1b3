// SPDX-License-Identifier: Apache-2.0
#include "harness/compare/recording_diff.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "harness/capture/trace.hpp"
#include "harness/compare/likeness.hpp"
#include "harness/core/hex.hpp"

namespace armjig {
namespace {

using Lane = std::span<const RecordedMessage>;
using Pair = std::pair<std::size_t, std::size_t>;  ///< places in the two recordings

std::string note_of(const CaptureRecord& record) {
  auto details = record.details;
  if (details.starts_with(R"("t_ms":)")) {
    details.remove_prefix(std::min(details.find(','), details.size() - 1) + 1);
  }
  return std::string{details};
}

/// What of the bytes is in none of the messages that they ended, in order.
std::vector<std::byte> rest_of(Bytes bytes, const std::vector<Message>& messages) {
  std::vector<std::byte> rest;
  auto at = bytes.begin();
  for (const auto& message : messages) {
    // Of a message that began in an earlier record, its end.
    auto raw = Bytes{message.raw};
    if (&message == messages.data() && raw.size() > bytes.size()) raw = raw.last(bytes.size());
    auto found = std::search(at, bytes.end(), raw.begin(), raw.end());
    while (&message == messages.data() && found == bytes.end() && !raw.empty()) {
      raw = raw.subspan(1);
      found = std::search(at, bytes.end(), raw.begin(), raw.end());
    }
    if (found == bytes.end()) continue;
    rest.insert(rest.end(), at, found);
    at = found + static_cast<std::ptrdiff_t>(raw.size());
  }
  rest.insert(rest.end(), at, bytes.end());
  return rest;
}

/// The longest common part of two sequences, by the fewest steps that lead from one to the other
/// (E. Myers, 1986). After `kMostSteps` the way that came furthest is taken and the search begins
/// anew at its end, so time and memory have a bound.
template <class Same>
class Alignment {
 public:
  Alignment(std::size_t before, std::size_t after, Same same)
      : size_{before, after}, same_{std::move(same)} {}

  [[nodiscard]] std::vector<Pair> pairs() {
    Pair at{};
    while (at.first < size_.first && at.second < size_.second) at = advance(at);
    return std::move(pairs_);
  }

 private:
  static constexpr int kMostSteps = 1024;
  using Row = std::vector<std::ptrdiff_t>;  ///< how far in the first, by diagonal

  Pair advance(Pair begin) {
    width_ = static_cast<std::ptrdiff_t>(size_.first - begin.first);
    height_ = static_cast<std::ptrdiff_t>(size_.second - begin.second);
    std::vector<Row> rows;
    std::ptrdiff_t best = 0;
    for (std::ptrdiff_t step = 0; step <= kMostSteps; ++step) {
      Row row(static_cast<std::size_t>(2 * step + 1), -1);
      std::ptrdiff_t furthest = -1;
      for (std::ptrdiff_t diagonal = -step; diagonal <= step; diagonal += 2) {
        auto x = step == 0 ? 0 : start_of(rows.back(), step, diagonal);
        if (x < 0) continue;
        while (x < width_ && x - diagonal < height_ && is_same(begin, x, diagonal)) ++x;
        row[static_cast<std::size_t>(diagonal + step)] = x;
        const auto sum = 2 * x - diagonal;
        if (sum < furthest || (sum == furthest && std::abs(diagonal) >= std::abs(best))) continue;
        furthest = sum;
        best = diagonal;
      }
      rows.push_back(std::move(row));
      if (furthest == width_ + height_) break;
    }
    return go_back(rows, best, begin);
  }

  bool is_same(Pair begin, std::ptrdiff_t x, std::ptrdiff_t diagonal) const {
    return same_(begin.first + static_cast<std::size_t>(x),
                 begin.second + static_cast<std::size_t>(x - diagonal));
  }

  static std::ptrdiff_t value(const Row& row, std::ptrdiff_t step, std::ptrdiff_t diagonal) {
    if (diagonal < -step || diagonal > step) return -1;
    return row[static_cast<std::size_t>(diagonal + step)];
  }

  /// Down one message of the second from the diagonal above; -1: there is none.
  std::ptrdiff_t from_above(const Row& last, std::ptrdiff_t step, std::ptrdiff_t diagonal) const {
    const auto x = value(last, step - 1, diagonal + 1);
    return x - diagonal > height_ ? -1 : x;
  }

  /// Where a diagonal begins: a message of the first is left out, or one of the second; -1:
  /// nowhere.
  std::ptrdiff_t start_of(const Row& last, std::ptrdiff_t step, std::ptrdiff_t diagonal) const {
    const auto left = value(last, step - 1, diagonal - 1);
    return std::max(left < 0 || left == width_ ? -1 : left + 1, from_above(last, step, diagonal));
  }

  /// Notes the pairs on the way that ended on the diagonal; answers its end.
  Pair go_back(const std::vector<Row>& rows, std::ptrdiff_t diagonal, Pair begin) {
    auto step = static_cast<std::ptrdiff_t>(rows.size()) - 1;
    auto x = value(rows.back(), step, diagonal);
    const Pair end{begin.first + static_cast<std::size_t>(x),
                   begin.second + static_cast<std::size_t>(x - diagonal)};
    const auto known = static_cast<std::ptrdiff_t>(pairs_.size());
    for (;; --step) {
      const auto* const last = step == 0 ? nullptr : &rows[static_cast<std::size_t>(step - 1)];
      const auto start = last == nullptr ? 0 : start_of(*last, step, diagonal);
      while (x > start) {
        --x;
        pairs_.emplace_back(begin.first + static_cast<std::size_t>(x),
                            begin.second + static_cast<std::size_t>(x - diagonal));
      }
      if (last == nullptr) break;
      const bool is_from_above = from_above(*last, step, diagonal) == start;
      x = is_from_above ? start : start - 1;
      diagonal += is_from_above ? 1 : -1;
    }
    std::reverse(pairs_.begin() + known, pairs_.end());
    return end;
  }

  Pair size_;
  Same same_;
  std::ptrdiff_t width_{};
  std::ptrdiff_t height_{};
  std::vector<Pair> pairs_;
};

/// One lane of both recordings.
class LaneDiff {
 public:
  LaneDiff(Lane before, Lane after, const Likeness& judge, const Likeness& matcher)
      : before_{before}, after_{after}, judge_{judge}, matcher_{matcher} {}

  [[nodiscard]] std::vector<RecordingDifference> run() {
    align({0, 0}, {before_.size(), after_.size()}, Level::kContentAndTime);
    return std::move(found_);
  }

 private:
  enum class Level : std::uint8_t { kContentAndTime, kContent, kKind, kNothing };

  [[nodiscard]] bool is_match(Level level, const RecordedMessage& one,
                              const RecordedMessage& other) const {
    if (level == Level::kKind) return one.message.name == other.message.name;
    return (level == Level::kContent || matcher_.is_in_time(one, other)) &&
           matcher_.has_same_content(one, other);
  }

  /// Pairs what matches, and what is between the pairs by the next level.
  void align(Pair begin, Pair end, Level level) {
    if (begin.first == end.first || begin.second == end.second || level == Level::kNothing) {
      return leave(begin, end);
    }
    const auto next = static_cast<Level>(static_cast<int>(level) + 1);
    auto same = [&](std::size_t one, std::size_t other) {
      return is_match(level, before_[begin.first + one], after_[begin.second + other]);
    };
    Alignment alignment{end.first - begin.first, end.second - begin.second, same};
    auto rest = begin;
    for (const auto& [one, other] : alignment.pairs()) {
      const Pair pair{begin.first + one, begin.second + other};
      align(rest, pair, next);
      judge(pair);
      rest = {pair.first + 1, pair.second + 1};
    }
    align(rest, end, next);
  }

  void judge(Pair pair) {
    const auto& one = before_[pair.first];
    const auto& other = after_[pair.second];
    if (judge_.is_in_time(one, other) && judge_.has_same_content(one, other)) return;
    auto what = judge_.differences(one, other);
    found_.push_back({.change = Change::kChanged,
                      .lane = {},
                      .before = &one,
                      .after = &other,
                      .what = std::move(what)});
  }

  void leave(Pair begin, Pair end) {
    for (auto i = begin.first; i < end.first; ++i) {
      found_.push_back(
          {.change = Change::kMissing, .lane = {}, .before = &before_[i], .after = nullptr});
    }
    for (auto i = begin.second; i < end.second; ++i) {
      found_.push_back(
          {.change = Change::kExtra, .lane = {}, .before = nullptr, .after = &after_[i]});
    }
  }

  Lane before_;
  Lane after_;
  const Likeness& judge_;
  const Likeness& matcher_;
  std::vector<RecordingDifference> found_;
};

/// What is missing in one place and extra in another has moved. Only what is bytewise the same.
void find_moved(std::vector<RecordingDifference>& found) {
  using Content = std::tuple<std::string_view, std::vector<std::byte>, std::string>;
  const auto content_of = [](const RecordedMessage& one) {
    return Content{one.message.name, one.message.raw, one.note};
  };
  std::map<Content, std::deque<RecordingDifference*>> extra;
  for (auto& one : found) {
    if (one.change == Change::kExtra) extra[content_of(*one.after)].push_back(&one);
  }
  for (auto& one : found) {
    if (one.change != Change::kMissing) continue;
    const auto same = extra.find(content_of(*one.before));
    if (same == extra.end() || same->second.empty()) continue;
    auto& other = *same->second.front();
    same->second.pop_front();
    one.change = Change::kMoved;
    one.after = std::exchange(other.after, nullptr);
    one.what.push_back(fmt::format("time: {} us, {} us", microseconds(one.before->message.time),
                                   microseconds(one.after->message.time)));
  }
  std::erase_if(found, [](const RecordingDifference& one) {
    return one.before == nullptr && one.after == nullptr;
  });
}

Lane lane_of(const RecordedMessages& recording, const std::string& name) {
  const auto found = recording.lanes().find(name);
  return found == recording.lanes().end() ? Lane{} : Lane{found->second};
}

}  // namespace

Outcome<void> RecordedMessages::add(const CaptureRecord& record) {
  if (count_ >= kMost) {
    return problem(
        ErrorCode::kUnsupported, "recording",
        fmt::format("it has more than {} messages; cut it with armjig trace cut", kMost));
  }
  const auto& link = *record.link;
  const bool is_bus = link.kind == LinkKind::kBus;
  const bool is_event = link.kind == LinkKind::kEvents;  // which go nowhere
  const auto number = is_event ? std::string{} : fmt::format(" {}", record.id);
  const auto whose = fmt::format("{} {}{}", link.device.empty() ? link.name : link.device,
                                 to_string(link.kind), number);
  const Message whole{.direction = is_event ? Direction::kFromDevice : record.direction,
                      .time = record.time,
                      .name = is_bus ? "transaction" : to_string(link.kind),
                      .raw = {record.bytes.begin(), record.bytes.end()},
                      .fields = {},
                      .fault = {}};
  const bool is_talk = is_bus || link.kind == LinkKind::kStream || link.kind == LinkKind::kSession;
  const auto make_dissector = is_talk ? find_dissector_(link.device) : nullptr;
  const auto bus_message = is_bus ? bus_message_of(record) : std::vector<std::byte>{};
  if (make_dissector == nullptr || (is_bus && bus_message.empty())) {
    keep(whose, {whole, link.kind == LinkKind::kStream ? std::string{} : note_of(record)});
    return {};
  }
  std::vector<Message> messages;
  auto& talk = talks_[{record.link, is_bus ? 0 : record.id}];
  if (talk.dissector && lost_before(record) > 0) {
    talk.dissector->finish(messages);
    talk.dissector.reset();
    keep_all(talk, messages, {});
    talk.pending.clear();
  }
  if (!talk.dissector) talk.dissector = make_dissector();
  talk.name = whose;
  talk.dissector->feed(record.direction, record.time, is_bus ? Bytes{bus_message} : record.bytes,
                       messages);
  if (is_bus && messages.empty()) messages.push_back(whole);
  auto& pending = talk.pending[record.direction];
  const bool has_rest = link.kind == LinkKind::kSession;
  if (has_rest) pending.bytes.insert(pending.bytes.end(), record.bytes.begin(), record.bytes.end());
  if (messages.empty()) {
    pending.times.push_back(record.time);
    return {};
  }
  const auto bytes = std::exchange(pending.bytes, {});
  keep_all(talk, messages, is_bus ? note_of(record) : std::string{},
           has_rest ? rest_of(bytes, messages) : std::vector<std::byte>{});
  return {};
}

void RecordedMessages::finish() {
  for (auto& [where, talk] : talks_) {
    std::vector<Message> messages;
    talk.dissector->finish(messages);
    keep_all(talk, messages, {});
  }
}

void RecordedMessages::keep(const std::string& lane, RecordedMessage message) {
  const auto name = fmt::format("{} {}", lane, to_string(message.message.direction));
  lanes_[name].push_back(std::move(message));
  ++count_;
}

void RecordedMessages::keep_all(Talk& talk, std::vector<Message>& messages, const std::string& note,
                                const std::vector<std::byte>& rest) {
  for (auto& message : messages) {
    const bool is_last = &message == &messages.back();
    auto& earlier = talk.pending[message.direction].times;
    keep(talk.name, {std::move(message), note, is_last ? rest : std::vector<std::byte>{},
                     std::exchange(earlier, {})});
  }
  messages.clear();
}

std::string_view to_string(Change change) noexcept {
  constexpr std::string_view kNames[] = {"changed", "missing", "extra", "moved"};
  return kNames[static_cast<std::size_t>(change)];
}

std::vector<RecordingDifference> diff(const RecordedMessages& before, const RecordedMessages& after,
                                      const ComparisonRules& rules) {
  return diff(before, after, rules, rules);
}

std::vector<RecordingDifference> diff(const RecordedMessages& before, const RecordedMessages& after,
                                      const ComparisonRules& rules,
                                      const ComparisonRules& aligning) {
  const Likeness judge{rules};
  const Likeness matcher{aligning};
  std::set<std::string> names;
  for (const auto* const recording : {&before, &after}) {
    for (const auto& [name, messages] : recording->lanes()) names.insert(name);
  }
  std::vector<RecordingDifference> all;
  for (const auto& name : names) {
    auto found = LaneDiff{lane_of(before, name), lane_of(after, name), judge, matcher}.run();
    std::erase_if(found, [&rules](const RecordingDifference& one) {
      return rules.ignores((one.before != nullptr ? one.before : one.after)->message.name);
    });
    find_moved(found);
    for (auto& one : found) {
      if (rules.is_order_free && one.change == Change::kMoved) continue;
      one.lane = name;
      all.push_back(std::move(one));
    }
  }
  std::ranges::stable_sort(all, {}, &RecordingDifference::time);
  return all;
}

}  // namespace armjig
