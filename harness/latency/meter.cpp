// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/meter.hpp"

#include <algorithm>
#include <utility>

namespace armjig {
namespace {

using namespace std::chrono_literals;
using Kind = MeterEvent::Kind;

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
    : path_{path},
      probe_{probe},
      plan_{plan},
      must_end_{std::move(must_end)},
      book_{plan, progress} {
  plan_.burst = std::clamp<std::size_t>(plan_.burst, 1, kMostBurst);
}

Result<bool> Meter::run(const Until& until) {
  if (auto drained = drain(); !drained) return tl::unexpected{drained.error()};
  const auto start = path_.now();
  const auto end = until.time > Duration::max() / 2 ? Instant::max() : start + until.time;
  const auto most = measured().sent + until.count;  // wraps if there is no end, and is behind then
  const bool is_counted = until.count < ~std::uint64_t{0};
  std::optional<PeriodicSchedule> schedule;
  if (plan_.period) schedule.emplace(start + *plan_.period, *plan_.period);
  bool is_wanted = true;
  Result<void> done;
  while (done && (is_wanted = !must_end_())) {
    const auto due = schedule ? schedule->next() : path_.now();
    if (due > end || (is_counted && measured().sent >= most)) break;
    auto deadline = due;
    if (schedule) {
      done = listen_until(due);
      if (!done) break;
      if (path_.now() < due) continue;  // somebody may want an end
      const auto cycle = schedule->begin(path_.now());
      if (cycle.deadline > end) {  // of those that passed by, the first ones were still wanted
        book_.skip(static_cast<std::uint64_t>((end - due) / *plan_.period) + 1);
        break;
      }
      deadline = cycle.deadline;
      book_.skip(cycle.skipped);
    }
    book_.note(Kind::kDue, deadline);
    done = send_burst(deadline);
    if (done) done = wait_for_answers();
  }
  book_.pass(path_.now() - start);
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
    book_.send(deadline, sent);
    probe_.leaves(sent);
    Result<void> written;
    for (const auto message : messages) {
      if (written) written = path_.send(message);
    }
    if (!written && !is_passing(written.error())) return written;
    book_.note(Kind::kSent, sent, messages.empty() ? 0 : messages.front().size());
    book_.record_lateness();
    if (!written) lose_pending();
  }
  return {};
}

Result<void> Meter::wait_for_answers() {
  while (book_.pending() > 0) {
    const auto patience = book_.oldest() + plan_.patience;
    const auto arrival = path_.receive(buffer_, std::min(patience, path_.now() + kLookAbout));
    if (!arrival) return tl::unexpected{arrival.error()};
    if (arrival->size > 0) {
      take(*arrival);
    } else if (path_.now() >= patience) {
      lose_pending();
      return listen_until(path_.now() + kSettle);
    } else if (must_end_()) {
      book_.forget();
      return {};
    }
  }
  return {};
}

/// Answers that come now are nobody's.
Result<void> Meter::listen_until(Instant time) {
  while (path_.now() < time && !must_end_()) {
    const auto arrival = path_.receive(buffer_, std::min(time, path_.now() + kLookAbout));
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
  book_.note(Kind::kCame, arrival.time, arrival.size);
  const auto answers = probe_.receive(arrival.time, bytes);
  for (std::size_t i = 0; i < answers; ++i) {
    book_.end(arrival, probe_.answered(book_.awaited(), arrival.time));
  }
  path_.overhear(bytes);
}

void Meter::lose_pending() {
  book_.lose(path_.now(), path_.now() + kSettle);
  probe_.lost();
}

}  // namespace armjig
