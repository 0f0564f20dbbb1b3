// SPDX-License-Identifier: Apache-2.0
#include "harness/console/watched.hpp"

#include <array>
#include <span>

namespace armjig {

Result<bool> WatchedStream::ask() {
  const auto message = request(now());
  if (message.empty()) return false;
  const auto written = link_.port().write(message);
  const bool is_alone = !written && written.error().code == ErrorCode::kNotFound;
  if (!written && !is_alone) return tl::unexpected{written.error()};
  return true;
}

Result<bool> WatchedStream::listen(Instant deadline) {
  std::array<std::byte, 4096> buffer;
  return link_.port().read(buffer, deadline).map([&](std::size_t size) {
    receive(now(), std::span{buffer}.first(size));
    return size > 0;
  });
}

}  // namespace armjig
