// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <thread>

#include "harness/core/time.hpp"
#include "harness/timing/lookout.hpp"

namespace armjig::cli {

/// Knows how long this process did not run although it wanted to: it was stopped, or the machine
/// had no time for it. A thread of its own looks at the clock as long as this lives.
class MissedTime {
 public:
  MissedTime();

  /// In all until now, of times of more than a tenth of a second. From any thread.
  [[nodiscard]] Duration total();

 private:
  std::mutex guard_;
  Lookout lookout_;
  Duration total_{};
  std::jthread thread_;
};

}  // namespace armjig::cli
