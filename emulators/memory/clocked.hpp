// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "emulators/memory/hosted.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// How the clock of a device goes, seen from outside.
struct DeviceClock {
  Instant begin{};  ///< what it says when it is 0 outside
  double rate = 1;  ///< its seconds in a second outside; above 0

  /// What it says then.
  [[nodiscard]] Instant inside(Instant outside) const;
  /// The first time outside at which it says that.
  [[nodiscard]] Instant outside(Instant inside) const;
};

/// The same device with such a clock: what it does by time comes earlier or later.
[[nodiscard]] std::unique_ptr<HostedStream> put_on_clock(std::unique_ptr<HostedStream> device,
                                                         const DeviceClock& clock);
[[nodiscard]] std::unique_ptr<HostedServer> put_on_clock(std::unique_ptr<HostedServer> device,
                                                         const DeviceClock& clock);
[[nodiscard]] std::unique_ptr<HostedBus> put_on_clock(std::unique_ptr<HostedBus> device,
                                                      const DeviceClock& clock);

}  // namespace armjig
