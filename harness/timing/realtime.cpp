// SPDX-License-Identifier: Apache-2.0
#include "harness/timing/realtime.hpp"

#include <fmt/core.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <system_error>

namespace armjig {
namespace {

std::string reason() { return std::generic_category().message(errno); }

bool set_priority(int policy, int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return ::sched_setscheduler(0, policy, &parameters) == 0;
}

Privilege processor_of(const RealtimeHow& how) {
  if (!how.processor) return {"processor", false, "none was asked for, the system may move us"};
  cpu_set_t only;
  CPU_ZERO(&only);
  const bool is_number = *how.processor >= 0 && *how.processor < CPU_SETSIZE;
  if (is_number) CPU_SET(static_cast<std::size_t>(*how.processor), &only);
  if (::sched_setaffinity(0, sizeof only, &only) == 0) {
    return {"processor", true, fmt::format("always on processor {}", *how.processor)};
  }
  return {"processor", false, fmt::format("processor {}: {}", *how.processor, reason())};
}

}  // namespace

Realtime::Realtime(const RealtimeHow& how) {
  has_priority_ = set_priority(SCHED_FIFO, how.priority);
  privileges_.push_back(
      {"priority", has_priority_,
       has_priority_ ? fmt::format("SCHED_FIFO {}", how.priority)
                     : fmt::format("no real-time priority ({}), so a busy machine delays us: see "
                                   "'armjig doctor'",
                                   reason())});
  has_memory_ = ::mlockall(MCL_CURRENT) == 0;
  privileges_.push_back(
      {"memory", has_memory_,
       has_memory_ ? std::string{"locked"}
                   : fmt::format("not locked ({}), so it may be swapped out: see 'armjig doctor'",
                                 reason())});
  privileges_.push_back(processor_of(how));
}

Realtime::~Realtime() {
  if (has_priority_) (void)set_priority(SCHED_OTHER, 0);
  if (has_memory_) ::munlockall();
}

void be_ordinary() noexcept {
  (void)set_priority(SCHED_OTHER, 0);
  cpu_set_t all;
  CPU_ZERO(&all);
  for (std::size_t i = 0; i < CPU_SETSIZE; ++i) CPU_SET(i, &all);
  (void)::sched_setaffinity(0, sizeof all, &all);
}

}  // namespace armjig
