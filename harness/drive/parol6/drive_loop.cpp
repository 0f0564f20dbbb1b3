// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/parol6/drive_loop.hpp"

#include <array>
#include <span>

namespace armjig::parol6::drive {

Result<void> DriveLoop::receive_until(Instant time) {
  std::array<std::byte, 4096> buffer;
  for (;;) {
    const auto size = port_.read(buffer, time);
    if (!size) return tl::unexpected{size.error()};
    drive_.receive(port_.now(), std::span{buffer}.first(*size));
    // A device that never stops sending must not keep us from our deadline.
    if (*size == 0 || port_.now() >= time) return {};
  }
}

Result<void> DriveLoop::cycle() {
  if (auto received = receive_until(schedule_.next()); !received) return received;
  const auto cycle = schedule_.begin(port_.now());
  skipped_ += cycle.skipped;
  jitter_.record(cycle.lateness);
  auto written = port_.write(drive_.tick(port_.now()));
  // A joint at top speed must not be sent two ways of a period in less than two (parol6.goto.law).
  skipped_ += schedule_.skip_until(port_.now());
  return written;
}

}  // namespace armjig::parol6::drive
