// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "harness/core/error.hpp"
#include "harness/drive/parol6/drive.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/timing/latency_histogram.hpp"
#include "harness/timing/schedule.hpp"

namespace armjig::parol6::drive {

/// Runs a drive over a port, a frame each period on absolute deadlines; in virtual time if the port
/// has it. For one thread.
class DriveLoop {
 public:
  DriveLoop(StreamPort& port, Drive& drive, Duration period = kFramePeriod) noexcept
      : port_{port}, drive_{drive}, schedule_{port.now(), period} {}

  /// Waits for the next deadline, handing what arrives to the drive, then sends its frame. Errors
  /// are the port's.
  [[nodiscard]] Result<void> cycle();

  /// Receives until `time` without sending: what is still under way at the end of a run.
  [[nodiscard]] Result<void> receive_until(Instant time);

  /// Deadlines at which nothing was sent because the loop came too late.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }
  /// How late sends were against their deadlines.
  [[nodiscard]] const LatencyHistogram& jitter() const noexcept { return jitter_; }

 private:
  StreamPort& port_;
  Drive& drive_;
  PeriodicSchedule schedule_;
  std::uint64_t skipped_ = 0;
  LatencyHistogram jitter_;
};

}  // namespace armjig::parol6::drive
