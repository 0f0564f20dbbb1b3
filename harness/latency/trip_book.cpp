// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/trip_book.hpp"

#include <algorithm>
#include <functional>

namespace armjig {
namespace {

using Kind = MeterEvent::Kind;

void insert(std::vector<Outlier>& worst, const Outlier& outlier) {
  const auto place = std::ranges::upper_bound(worst, outlier.trip.duration, std::greater{},
                                              [](const Outlier& one) { return one.trip.duration; });
  worst.insert(place, outlier);
  if (worst.size() > TripBook::kOutliers) worst.pop_back();
}

}  // namespace

void Measured::add(const Measured& other) {
  round_trips.add(other.round_trips);
  corrected.add(other.corrected);
  lateness.add(other.lateness);
  delivery.add(other.delivery);
  const auto room = TripBook::kMostTrips - std::min(trips.size(), TripBook::kMostTrips);
  const auto taken = std::min(room, other.trips.size());
  trips.insert(trips.end(), other.trips.begin(),
               other.trips.begin() + static_cast<std::ptrdiff_t>(taken));
  for (const auto& outlier : other.outliers) insert(outliers, outlier);
  sent += other.sent;
  lost += other.lost;
  skipped += other.skipped;
  surplus += other.surplus;
  unkept += other.unkept + other.trips.size() - taken;
  time += other.time;
}

TripBook::TripBook(const MeterPlan& plan, MeterProgress* progress)
    : period_{plan.period}, progress_{progress} {
  measured_.trips.reserve(std::min(plan.expected, kMostTrips));
  measured_.outliers.reserve(kOutliers + 1);
}

void TripBook::send(Instant deadline, Instant sent) noexcept {
  pending_[sent_++ % kMostPending] = {deadline, sent};
  ++measured_.sent;
}

void TripBook::record_lateness() noexcept {
  if (!period_) return;
  const auto& [deadline, sent] = pending_[(sent_ - 1) % kMostPending];
  // Waiting for the answer before is not the host's doing.
  measured_.lateness.record(sent - std::max(deadline, free_since_));
}

void TripBook::end(const Path::Arrival& arrival, std::optional<Duration> shift) {
  if (pending() == 0) {
    ++measured_.surplus;
    return;
  }
  const auto [deadline, sent] = pending_[ended_++ % kMostPending];
  RoundTrip trip{
      .sent = sent, .duration = arrival.time - sent, .late = sent - deadline, .shift = shift};
  if (arrival.kernel) {
    trip.delivery = arrival.time - *arrival.kernel;
    measured_.delivery.record(*trip.delivery);
  }
  measured_.round_trips.record(trip.duration);
  if (period_) {
    measured_.corrected.record_corrected(arrival.time - deadline, *period_);
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
  keep_if_worst(trip);
  if (progress_ != nullptr) {
    progress_->answered.fetch_add(1, std::memory_order_relaxed);
    progress_->worst.store(measured_.round_trips.max().count(), std::memory_order_relaxed);
  }
}

void TripBook::lose(Instant now, Instant settled) noexcept {
  const auto lost = pending();
  free_since_ = settled;
  note(Kind::kLost, now);
  measured_.lost += lost;
  forget();
  if (progress_ != nullptr) progress_->lost.fetch_add(lost, std::memory_order_relaxed);
}

void TripBook::note(MeterEvent::Kind kind, Instant time, std::size_t bytes) noexcept {
  events_[event_count_++ % events_.size()] = {kind, time, bytes};
}

void TripBook::keep_if_worst(const RoundTrip& trip) {
  auto& worst = measured_.outliers;
  if (worst.size() == kOutliers && trip.duration <= worst.back().trip.duration) return;
  Outlier outlier{.trip = trip, .event_count = std::min(event_count_, events_.size())};
  for (std::size_t i = 0; i < outlier.event_count; ++i) {
    outlier.events[i] = events_[(event_count_ - outlier.event_count + i) % events_.size()];
  }
  insert(worst, outlier);
}

}  // namespace armjig
