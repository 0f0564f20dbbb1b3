// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/recorded.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <utility>

#include "harness/capture/trace.hpp"
#include "harness/timing/histogram_log.hpp"

namespace armjig {
namespace {

using Kind = MeterEvent::Kind;

/// How much of a steady rate has to be steady, and how steady.
constexpr double kSteadyShare = 0.8;
constexpr int kSteadiness = 10;  ///< one part of so many
constexpr std::size_t kFewestIntervals = 10;

/// One stream, connection or bus. What was said since nobody waited is held until it is clear which
/// answer belongs to which request.
class Conversation {
 public:
  explicit Conversation(const RecordedHow& how)
      : counter_{how.make_listener()},
        listener_{how.make_listener()},
        patience_{how.patience},
        book_{{.period = std::nullopt}} {}

  void take(Instant time, Direction direction, std::vector<std::byte> bytes) {
    while (pending_ > 0 && time > oldest() + patience_) lose_oldest();
    const bool is_request = direction == Direction::kToDevice;
    if (!is_request) time += counter_->rest_of(bytes);
    const auto count =
        is_request ? counter_->requested(time, bytes) : counter_->receive(time, bytes);
    held_.push_back({time, is_request, count, std::move(bytes)});
    pending_ = after(is_request, count, pending_);
    if (pending_ == 0) settle(held_.size());
  }
  /// Nobody knows whether what is still waited for would have come.
  void finish() {
    settle(held_.size());
    book_.forget();
  }

  [[nodiscard]] const Measured& measured() const noexcept { return book_.measured(); }
  [[nodiscard]] const Probe& listener() const noexcept { return *listener_; }
  /// Between one request and the next.
  [[nodiscard]] const std::vector<Duration>& intervals() const noexcept { return intervals_; }

 private:
  struct Said {
    Instant time{};
    bool is_request{};
    std::size_t count{};  ///< of requests or answers
    std::vector<std::byte> bytes;
  };

  static std::size_t after(bool is_request, std::size_t count, std::size_t pending) noexcept {
    return is_request ? pending + count : pending - std::min(pending, count);
  }

  /// Of the requests that are not lost.
  [[nodiscard]] Instant oldest() const noexcept {
    std::size_t seen = 0;
    for (const auto& one : held_) {
      if (one.is_request && (seen += one.count) > lost_) return one.time;
    }
    return Instant::max();
  }

  /// The answers belong to the requests after it, then.
  void lose_oldest() {
    ++lost_;
    auto skipped = lost_;
    std::size_t pending = 0;
    for (std::size_t i = 0; i < held_.size(); ++i) {
      const auto& said = held_[i];
      const auto here = said.is_request ? std::min(skipped, said.count) : 0;
      skipped -= here;
      pending = after(said.is_request, said.count - here, pending);
      if (pending > 0 || skipped > 0) continue;
      settle(i + 1);
      i = ~std::size_t{0};  // what follows begins from nothing
    }
    pending_ = pending;
  }

  /// The first so many are clear: as if they were measured now.
  void settle(std::size_t count) {
    for (; count > 0; --count) {
      const auto said = std::move(held_.front());
      held_.pop_front();
      if (said.is_request) {
        send(said);
        continue;
      }
      book_.note(Kind::kCame, said.time, said.bytes.size());
      const auto answers = listener_->receive(said.time, said.bytes);
      for (std::size_t i = 0; i < answers; ++i) {
        book_.end({.size = said.bytes.size(), .time = said.time},
                  listener_->answered(book_.awaited(), said.time));
      }
    }
    pending_ = book_.pending();
    lost_ = 0;
  }

  void send(const Said& said) {
    (void)listener_->requested(said.time, said.bytes);
    if (said.count == 0) return;
    book_.note(Kind::kSent, said.time, said.bytes.size());
    for (std::size_t i = 0; i < said.count; ++i) {
      if (last_sent_ && intervals_.size() < TripBook::kMostTrips) {
        intervals_.push_back(said.time - *last_sent_);
      }
      last_sent_ = said.time;
      const bool is_lost = lost_ > 0 || book_.pending() + 1 >= TripBook::kMostPending;
      book_.send(said.time, said.time);
      if (!is_lost) continue;
      book_.lose(said.time, said.time);
      lost_ -= std::min<std::size_t>(lost_, 1);
    }
  }

  std::unique_ptr<Probe> counter_;   ///< is told at once
  std::unique_ptr<Probe> listener_;  ///< is told what is clear
  Duration patience_;
  TripBook book_;
  std::deque<Said> held_;
  std::size_t pending_ = 0;  ///< after what is held
  std::size_t lost_ = 0;     ///< of the oldest requests that are held
  std::optional<Instant> last_sent_;
  std::vector<Duration> intervals_;
};

/// The period of requests that leave steadily, unless it is only how long answers take.
std::optional<Duration> period_of(std::vector<Duration> intervals, Duration round_trip) {
  if (intervals.size() < kFewestIntervals) return std::nullopt;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::ranges::nth_element(intervals, middle);
  const auto period = *middle;
  const auto least = period - period / kSteadiness;
  const auto steady = std::ranges::count_if(intervals, [&](Duration interval) {
    return interval >= least && interval <= period + period / kSteadiness;
  });
  const bool is_steady =
      static_cast<double>(steady) >= kSteadyShare * static_cast<double>(intervals.size());
  if (!is_steady || period <= Duration{} || round_trip >= least) return std::nullopt;
  return period;
}

/// What the schedule tells: the requests that were not sent, and what they would have seen.
void correct(Measured& measured, const std::vector<Duration>& intervals, Duration period) {
  for (const auto interval : intervals) {
    const auto periods = (interval + period / 2) / period;
    if (periods > 1) measured.skipped += static_cast<std::uint64_t>(periods - 1);
  }
  measured.corrected = {};
  for (const auto& trip : measured.trips)
    measured.corrected.record_corrected(trip.duration, period);
}

std::optional<std::chrono::sys_seconds> started_of(const CaptureHeader& header) {
  if (header.epoch_ns == 0) return std::nullopt;
  return std::chrono::floor<std::chrono::seconds>(
      std::chrono::sys_time<std::chrono::nanoseconds>{std::chrono::nanoseconds{header.epoch_ns}});
}

}  // namespace

Outcome<LatencyRun> run_of(CaptureReader& reader, const RecordedHow& how) {
  std::map<std::pair<std::string, std::uint32_t>, Conversation> conversations;
  std::optional<Instant> first;
  Instant last{};
  CaptureRecord record;
  for (;;) {
    const auto is_there = reader.next(record);
    if (!is_there) return tl::unexpected{is_there.error()};
    if (!*is_there) break;
    const auto& link = *record.link;
    const bool is_talk = link.kind == LinkKind::kStream || link.kind == LinkKind::kSession ||
                         link.kind == LinkKind::kBus;
    const auto& device = link.device.empty() ? reader.header().device : link.device;
    if (!is_talk || !how.is_ours(device)) continue;
    auto bytes = link.kind == LinkKind::kBus
                     ? bus_message_of(record)
                     : std::vector<std::byte>{record.bytes.begin(), record.bytes.end()};
    if (bytes.empty()) continue;
    const auto id = link.kind == LinkKind::kSession ? record.id : 0;
    conversations.try_emplace({link.name, id}, how)
        .first->second.take(record.time, record.direction, std::move(bytes));
    first = first.value_or(record.time);
    last = record.time;
  }

  LatencyRun run{.device = reader.header().device,
                 .path = "a recording, with the times that it has",
                 .started = started_of(reader.header()),
                 .plan = {.period = std::nullopt},
                 .is_recorded = true};
  run.exchange = how.make_listener()->exchange();
  std::vector<Duration> intervals;
  const Conversation* longest = nullptr;
  for (auto& [name, conversation] : conversations) {
    conversation.finish();
    run.measured.add(conversation.measured());
    intervals.insert(intervals.end(), conversation.intervals().begin(),
                     conversation.intervals().end());
    const auto answers = [](const Conversation& one) { return one.measured().round_trips.count(); };
    if (longest == nullptr || answers(conversation) > answers(*longest)) longest = &conversation;
  }
  auto& measured = run.measured;
  std::ranges::stable_sort(measured.trips, {}, &RoundTrip::sent);
  measured.time = last - first.value_or(last);
  run.left_out = {"a sentinel", "permissions and load", "the kernel's time stamps"};
  run.plan.period = period_of(intervals, measured.round_trips.percentile(50));
  if (run.plan.period) {
    correct(measured, intervals, *run.plan.period);
    run.left_out.emplace_back("deadlines: the period is that of the requests");
  } else {
    run.left_out.emplace_back("a schedule: the requests show none, so nothing is corrected");
  }
  if (measured.unkept > 0) {
    run.left_out.push_back(fmt::format("the order of the last {} answers", measured.unkept));
  }
  if (longest == nullptr) return run;
  run.time_on_wire = longest->listener().time_on_wire();
  run.figures = longest->listener().figures(
      {.period = run.plan.period, .median = measured.round_trips.percentile(50)});
  return run;
}

Outcome<LatencyRun> run_of_log(std::string_view log, const std::string& where) {
  const auto intervals = parse_histogram_log(log);
  if (!intervals) {
    return problem(ErrorCode::kMalformed, fmt::format("{}:{}", where, intervals.error().detail),
                   "it is no line of an HdrHistogram log");
  }
  LatencyRun run{.path = "a log of histograms",
                 .plan = {.period = std::nullopt},
                 .left_out = {"the order of the answers, so intervals and the worst", "a sentinel",
                              "permissions and load", "a schedule"},
                 .is_recorded = true};
  for (const auto& interval : *intervals) {
    if (interval.tag == "corrected") {
      run.measured.corrected.add(interval.histogram);
    } else if (interval.tag.empty() || interval.tag == "raw") {
      run.measured.round_trips.add(interval.histogram);
      run.measured.time += std::chrono::duration_cast<Duration>(interval.length);
    }
  }
  run.measured.sent = run.measured.round_trips.count();
  if (run.measured.corrected.count() == 0) run.measured.corrected = run.measured.round_trips;
  return run;
}

}  // namespace armjig
