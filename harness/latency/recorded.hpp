// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/capture/capture.hpp"
#include "harness/latency/latency_run.hpp"

namespace armjig {

/// What is needed to find round trips in a recording.
struct RecordedHow {
  std::function<std::unique_ptr<Probe>()> make_listener;
  /// Whether a link that says so in the recording is of the device; empty: nobody said.
  std::function<bool(std::string_view device)> is_ours;
  Duration patience = std::chrono::seconds{1};  ///< after which an answer is lost
};

/// The run that a recording shows: each connection and each stream by itself, a bus as a whole.
/// Answers belong to requests in their order; one that never came is noticed when the answers after
/// it stay one short for `patience`. What a recording does not have is in `left_out`: no sentinel,
/// no kernel, and deadlines only if the requests come at a steady rate that no answer sets.
/// Problems: the reader's.
[[nodiscard]] Outcome<LatencyRun> run_of(CaptureReader& reader, const RecordedHow& how);

/// The run of which only the histograms are left, as `to_latency_log` has them; what a log that
/// others wrote has without a tag is taken as it was. Problems: `kMalformed`; `where` is for
/// messages.
[[nodiscard]] Outcome<LatencyRun> run_of_log(std::string_view log, const std::string& where);

}  // namespace armjig
