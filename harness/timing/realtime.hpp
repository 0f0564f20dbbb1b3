// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace armjig {

/// One of the things that keep a loop on time, and whether the system granted it.
struct Privilege {
  std::string name;  ///< `priority`, `memory` or `processor`
  bool is_granted = false;
  std::string text;  ///< what we have, or why not and what it costs; one sentence
};

struct RealtimeHow {
  int priority = 50;             ///< of SCHED_FIFO
  std::optional<int> processor;  ///< to stay on; none: the system chooses
};

/// For the calling thread, and those that it starts: real-time priority and a processor; for the
/// process: memory that stays. What is not granted is said and does no harm. `doctor` says how to
/// get it. Undone when it goes.
class Realtime {
 public:
  explicit Realtime(const RealtimeHow& how);
  Realtime(const Realtime&) = delete;
  Realtime& operator=(const Realtime&) = delete;
  ~Realtime();

  [[nodiscard]] const std::vector<Privilege>& privileges() const noexcept { return privileges_; }

 private:
  std::vector<Privilege> privileges_;
  bool has_priority_ = false;
  bool has_memory_ = false;
};

/// For a thread that only makes work: no priority, and any processor.
void be_ordinary() noexcept;

}  // namespace armjig
