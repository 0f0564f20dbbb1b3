// SPDX-License-Identifier: Apache-2.0
#include "cli/missed_time.hpp"

#include <chrono>
#include <stop_token>

namespace armjig::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenLooks = 10ms;
constexpr auto kLongest = 100ms;

}  // namespace

MissedTime::MissedTime()
    : lookout_{kLongest, Lookout::Wall::now()}, thread_{[this](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          (void)total();
          std::this_thread::sleep_for(kBetweenLooks);
        }
      }} {}

/// Who asks looks too, for after a stop it may run before the thread does.
Duration MissedTime::total() {
  const std::lock_guard lock{guard_};
  if (const auto gap = lookout_.look(Lookout::Wall::now())) total_ += gap->to - gap->from;
  return total_;
}

}  // namespace armjig::cli
