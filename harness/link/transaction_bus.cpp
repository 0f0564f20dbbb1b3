// SPDX-License-Identifier: Apache-2.0
#include "harness/link/transaction_bus.hpp"

#include <algorithm>
#include <thread>

namespace armjig {

void RealBus::wait_until(Instant time) {
  const auto wait = time - now();
  if (wait > Duration{}) std::this_thread::sleep_for(wait);
}

bool RealBus::can_do(std::span<const BusMessage> messages, std::size_t most,
                     std::size_t longest) noexcept {
  return !messages.empty() && messages.size() <= most &&
         std::ranges::all_of(messages, [longest](const BusMessage& message) {
           return std::max(message.write.size(), message.read.size()) <= longest;
         });
}

}  // namespace armjig
