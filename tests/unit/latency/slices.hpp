// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "harness/latency/comparison.hpp"
#include "harness/latency/meter.hpp"
#include "harness/link/memory_stream.hpp"
#include "tests/unit/latency/delayed_echo.hpp"

namespace armjig::test {

/// So many slices of a quarter of a second, in virtual time, at 100 requests a second.
inline std::vector<Slice> slices_of(std::size_t count, DelayedEcho::Delay delay) {
  MemoryStream<DelayedEcho> port{DelayedEcho{std::move(delay)}};
  EchoProbe probe;
  const auto path = path_through(port);
  Meter meter{*path, probe, {}, [] { return false; }};
  std::vector<Slice> slices;
  while (slices.size() < count) {
    const auto before = meter.measured().trips.size();
    if (!meter.run({.time = std::chrono::milliseconds{250}})) return {};
    slices.push_back(slice_of(std::span{meter.measured().trips}.subspan(before)));
  }
  return slices;
}

}  // namespace armjig::test
