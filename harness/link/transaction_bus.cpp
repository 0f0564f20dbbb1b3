// SPDX-License-Identifier: Apache-2.0
#include "harness/link/transaction_bus.hpp"

#include <thread>

namespace armjig {

void RealBus::wait_until(Instant time) {
  const auto wait = time - now();
  if (wait > Duration{}) std::this_thread::sleep_for(wait);
}

}  // namespace armjig
