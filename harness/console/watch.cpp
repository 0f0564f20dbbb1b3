// SPDX-License-Identifier: Apache-2.0
#include "harness/console/watch.hpp"

#include <fmt/core.h>

#include <chrono>

namespace armjig {

bool Watch::is_over() const {
  const auto done = asked_ > 0 ? asked_ : watched_.answers();
  if (plan_.count && done >= *plan_.count) return true;
  return plan_.time && schedule_.next() - start_ >= *plan_.time;
}

Result<void> Watch::cycle(const Heard& heard) {
  if (auto listened = listen_until(schedule_.next(), heard); !listened) return listened;
  const auto cycle = schedule_.begin(watched_.now());
  skipped_ += cycle.skipped;
  lateness_.record(cycle.lateness);
  const auto asked = watched_.ask();
  if (!asked) return tl::unexpected{asked.error()};
  if (*asked) ++asked_;
  return {};
}

Result<void> Watch::end(const Heard& heard) {
  auto listened = listen_until(schedule_.next(), heard);
  watched_.finish();
  return listened;
}

Result<void> Watch::listen_until(Instant time, const Heard& heard) {
  for (;;) {
    const auto came = watched_.listen(time);
    if (!came) return tl::unexpected{came.error()};
    heard();
    // A device that never stops sending must not keep us from our deadline.
    if (!*came || watched_.now() >= time) return {};
  }
}

double Watch::seconds_since_start() const {
  return std::chrono::duration<double>{watched_.now() - start_}.count();
}

std::string Watch::page(std::string_view title) const {
  const auto state = watched_.panel();
  return fmt::format("{}, {:.1f} s\n\n{}\n{}", title, seconds_since_start(),
                     state.empty() ? "no telemetry yet\n" : state, summary());
}

std::string Watch::summary() const {
  return fmt::format("{}schedule   {} skipped, late by {} at 50 %, 99 % and most\n",
                     watched_.link(), skipped_, lateness_.summary());
}

}  // namespace armjig
