// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "harness/core/error.hpp"

namespace armjig {

/// Work for the machine while something else is measured: how many threads that compute, and that
/// write to a file and wait for the disk.
struct LoadPlan {
  unsigned cpu = 0;
  unsigned io = 0;
};

/// Reads `cpu=2,io=1`; at most 64 of each. Problems: `kBadValue`.
[[nodiscard]] Outcome<LoadPlan> parse_load(std::string_view text);

/// Works as long as it lives, at ordinary priority.
class Load {
 public:
  explicit Load(const LoadPlan& plan);
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;
  ~Load();

 private:
  std::atomic<bool> must_end_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace armjig
