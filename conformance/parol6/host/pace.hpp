// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "conformance/program_checker.hpp"
#include "harness/core/time.hpp"

namespace armjig::parol6::programs {

/// Judges when a program sends its frames.
class Pace {
 public:
  explicit Pace(Duration noise) noexcept : noise_{noise} {}

  void judge(Instant time, const Complain& complain);

 private:
  void judge_window(Instant time, const Complain& complain) const;

  Duration noise_;
  std::optional<Instant> last_;
  Instant window_begin_{};
  int frames_ = 0;    ///< in this window
  int off_beat_ = 0;  ///< of them, those that came too early or too late
};

}  // namespace armjig::parol6::programs
