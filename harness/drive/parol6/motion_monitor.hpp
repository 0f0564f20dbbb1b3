// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "harness/core/quantity.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::drive {

/// Compares what a board says it does with what its counters show. Fed with every telemetry frame
/// and the command that the board acts on.
class MotionMonitor {
 public:
  struct Findings {
    std::optional<std::size_t> started{};  ///< a joint that should move does so for the first time
    std::optional<std::size_t> stalled{};  ///< one that should move has not
    std::optional<std::size_t> still_moves{};  ///< one that should stand has moved
  };

  /// A new command begins at `now`: grace and findings start anew.
  void begin(Instant now) noexcept;

  /// The board acts on `command`, and this is its next telemetry. Findings come once a command.
  Findings observe(Instant now, const CommandFrame& command,
                   const TelemetryFrame& telemetry) noexcept;

 private:
  struct Joint {
    std::int32_t position = 0;
    double due_steps = 0;  ///< that it should have made since it last moved
    Instant moved{};
  };

  std::array<Joint, kJointCount> joints_{};
  std::optional<Instant> last_;
  Instant began_{};
  bool has_started_ = false;
  bool has_stalled_ = false;
  bool has_moved_on_ = false;
};

}  // namespace armjig::parol6::drive
