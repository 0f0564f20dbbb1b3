// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/support/bare_trips.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>

namespace armjig::testing {

void echo(int file) {
  std::array<std::byte, 256> buffer;
  for (;;) {
    pollfd entry{.fd = file, .events = POLLIN, .revents = 0};
    (void)::poll(&entry, 1, -1);
    const auto size = ::read(file, buffer.data(), buffer.size());
    if (size <= 0) return;
    (void)!::write(file, buffer.data(), static_cast<std::size_t>(size));
  }
}

Trips trips_of(const LatencyHistogram& histogram) {
  return {static_cast<double>(histogram.percentile(50).count()),
          static_cast<double>(histogram.percentile(99).count())};
}

Trips bare_trips(int file, Bytes request, std::size_t count) {
  using Clock = std::chrono::steady_clock;
  LatencyHistogram histogram;
  std::array<std::byte, 256> buffer;
  for (std::size_t i = 0; i < count; ++i) {
    const auto sent = Clock::now();
    (void)!::write(file, request.data(), request.size());
    for (std::size_t came = 0; came < request.size();) {
      pollfd entry{.fd = file, .events = POLLIN, .revents = 0};
      (void)::poll(&entry, 1, -1);
      const auto size = ::read(file, buffer.data(), buffer.size());
      if (size > 0) came += static_cast<std::size_t>(size);
    }
    histogram.record(Clock::now() - sent);
  }
  return trips_of(histogram);
}

double middle(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace armjig::testing
