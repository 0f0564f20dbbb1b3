// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/meter.hpp"

#include <algorithm>
#include <utility>

namespace armjig {
namespace {

using namespace std::chrono_literals;
using Kind = MeterEvent::Kind;

/// How long nobody asks whether to end.
constexpr Duration kSlice = 100ms;
/// In which late answers are thrown away after one was lost, or they would be taken for others'.
constexpr Duration kSettle = 100ms;

/// Whether only this request has failed: a bus on which nobody acknowledged, or that was busy.
bool is_passing(const Error& error) noexcept {
  return error.code == ErrorCode::kNotFound || error.code == ErrorCode::kBusy ||
         error.code == ErrorCode::kTimedOut;
}

}  // namespace

Meter::Meter(Path& path, Probe& probe, const MeterPlan& plan, std::function<bool()> must_end,
             MeterProgress* progress)
    : path_{path}, probe_{probe}, plan_{plan}, must_end_{std::move(must_end)}, progress_{progress} {
  plan_.burst = std::clamp<std::size_t>(plan_.burst, 1, kMostBurst);
  measured_.trips.reserve(std::min(plan_.expected, kMostTrips));
  measured_.outliers.reserve(kOutliers + 1);
}

Result<bool> Meter::run(const Until& until) {
  if (auto drained = drain(); !drained) return tl::unexpected{drained.error()};
  const auto start = path_.now();
  const auto end = until.time > Duration::max() / 2 ? Instant::max() : start + until.time;
  const auto most = measured_.sent + until.count;  // wraps if there is no end, and is behind then
  const bool is_counted = until.count < ~std::uint64_t{0};
  std::optional<PeriodicSchedule> schedule;
  if (plan_.period) schedule.emplace(start + *plan_.period, *plan_.period);
  bool is_wanted = true;
  Result<void> done;
  while (done && (is_wanted = !must_end_())) {
    const auto due = schedule ? schedule->next() : path_.now();
    if (due > end || (is_counted && measured_.sent >= most)) break;
    auto deadline = due;
    if (schedule) {
      done = listen_until(due);
      if (!done) break;
      if (path_.now() < due) continue;  // somebody may want an end
      const auto cycle = schedule->begin(path_.now());
      deadline = cycle.deadline;
      measured_.skipped += cycle.skipped;
    }
    note(Kind::kDue, deadline);
    done = send_burst(deadline);
    if (done) done = wait_for_answers();
  }
  measured_.time += path_.now() - start;
  if (!done) return tl::unexpected{done.error()};
  return is_wanted;
}

Result<void> Meter::send_burst(Instant deadline) {
  for (std::size_t i = 0; i < plan_.burst; ++i) {
    const auto messages = probe_.request();
    for (const auto message : messages) {
      if (auto announced = path_.announce(message); !announced) return announced;
    }
    if (auto drained = drain(); !drained) return drained;
    const auto sent = path_.now();
    pending_[sent_++ % kMostBurst] = {deadline, sent};
    ++measured_.sent;
    Result<void> written;
    for (const auto message : messages) {
      if (written) written = path_.send(message);
    }
    if (!written && !is_passing(written.error())) return written;
    note(Kind::kSent, sent, messages.empty() ? 0 : messages.front().size());
    // Waiting for the answer before is not the host's doing.
    if (plan_.period) measured_.lateness.record(sent - std::max(deadline, free_since_));
    if (!written) lose_pending();
  }
  return {};
}

Result<void> Meter::wait_for_answers() {
  while (pending() > 0) {
    const auto patience = pending_[ended_ % kMostBurst].sent + plan_.patience;
    const auto arrival = path_.receive(buffer_, std::min(patience, path_.now() + kSlice));
    if (!arrival) return tl::unexpected{arrival.error()};
    if (arrival->size > 0) {
      take(*arrival);
    } else if (path_.now() >= patience) {
      lose_pending();
      return listen_until(path_.now() + kSettle);
    } else if (must_end_()) {
      ended_ = sent_;  // nobody waited long enough to call them lost
      return {};
    }
  }
  return {};
}

/// Answers that come now are nobody's.
Result<void> Meter::listen_until(Instant time) {
  while (path_.now() < time && !must_end_()) {
    const auto arrival = path_.receive(buffer_, std::min(time, path_.now() + kSlice));
    if (!arrival) return tl::unexpected{arrival.error()};
    if (arrival->size > 0) take(*arrival);
  }
  return {};
}

Result<void> Meter::drain() {
  for (;;) {
    const auto arrival = path_.drain(buffer_);
    if (!arrival) return tl::unexpected{arrival.error()};
    if (arrival->size == 0) return {};
    take(*arrival);
  }
}

void Meter::take(const Path::Arrival& arrival) {
  const auto bytes = Bytes{buffer_}.first(arrival.size);
  note(Kind::kCame, arrival.time, arrival.size);
  const auto answers = probe_.receive(arrival.time, bytes);
  for (std::size_t i = 0; i < answers; ++i) {
    pending() > 0 ? end_trip(arrival) : static_cast<void>(++measured_.surplus);
  }
  path_.overhear(bytes);
}

void Meter::end_trip(const Path::Arrival& arrival) {
  const auto [deadline, sent] = pending_[ended_++ % kMostBurst];
  RoundTrip trip{.sent = sent, .duration = arrival.time - sent, .late = sent - deadline};
  if (arrival.kernel) {
    trip.delivery = arrival.time - *arrival.kernel;
    measured_.delivery.record(*trip.delivery);
  }
  measured_.round_trips.record(trip.duration);
  if (plan_.period) {
    measured_.corrected.record_corrected(arrival.time - deadline, *plan_.period);
  } else {
    measured_.corrected.record(trip.duration);
  }
  if (measured_.trips.size() < kMostTrips) {
    measured_.trips.push_back(trip);
  } else {
    ++measured_.unkept;
  }
  note(Kind::kAnswered, arrival.time);
  free_since_ = arrival.time;
  probe_.answered(sent, arrival.time);
  keep_if_worst(trip);
  if (progress_ == nullptr) return;
  progress_->answered.fetch_add(1, std::memory_order_relaxed);
  progress_->worst.store(measured_.round_trips.max().count(), std::memory_order_relaxed);
}

void Meter::lose_pending() {
  const auto lost = pending();
  free_since_ = path_.now() + kSettle;
  note(Kind::kLost, path_.now());
  measured_.lost += lost;
  ended_ = sent_;
  if (progress_ != nullptr) progress_->lost.fetch_add(lost, std::memory_order_relaxed);
}

void Meter::note(MeterEvent::Kind kind, Instant time, std::size_t bytes) noexcept {
  events_[event_count_++ % events_.size()] = {kind, time, bytes};
}

void Meter::keep_if_worst(const RoundTrip& trip) {
  auto& worst = measured_.outliers;
  if (worst.size() == kOutliers && trip.duration <= worst.back().trip.duration) return;
  Outlier outlier{.trip = trip, .event_count = std::min(event_count_, events_.size())};
  for (std::size_t i = 0; i < outlier.event_count; ++i) {
    outlier.events[i] = events_[(event_count_ - outlier.event_count + i) % events_.size()];
  }
  const auto place = std::ranges::upper_bound(worst, trip.duration, std::greater{},
                                              [](const Outlier& one) { return one.trip.duration; });
  worst.insert(place, outlier);
  if (worst.size() > kOutliers) worst.pop_back();
}

}  // namespace armjig
