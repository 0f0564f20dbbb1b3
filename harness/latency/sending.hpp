// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "harness/core/error.hpp"
#include "harness/latency/path.hpp"
#include "harness/latency/probe.hpp"
#include "harness/timing/latency_histogram.hpp"

namespace armjig {

/// Further requests, after those that are measured.
struct SendingPlan {
  std::uint64_t count{};
  Duration period{};    ///< between two of them
  Duration patience{};  ///< with an answer
};

/// How long after the call the kernel handed each request to the link. That is not asked while
/// round trips are measured: the kernel says it on the socket's error queue, which wakes whoever
/// polls for the answer. Empty: the link has no such stamps. Errors: the path's.
[[nodiscard]] Result<LatencyHistogram> time_sending(Path& path, Probe& probe,
                                                    const SendingPlan& plan,
                                                    const std::function<bool()>& must_end);

}  // namespace armjig
