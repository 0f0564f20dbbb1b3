// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/timing/latency_histogram.hpp"

/// What others are measured beside: an echo and a client of it that do nothing but poll, read and
/// write.
namespace armjig::testing {

/// Sends back what comes, until the other end is closed.
void echo(int file);

/// Nanoseconds.
struct Trips {
  double median;
  double p99;
};

[[nodiscard]] Trips trips_of(const LatencyHistogram& histogram);

/// That many round trips of the request, one after the other.
[[nodiscard]] Trips bare_trips(int file, Bytes request, std::size_t count);

/// Requires some.
[[nodiscard]] double middle(std::vector<double> values);

}  // namespace armjig::testing
