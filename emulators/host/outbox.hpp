// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <vector>

#include "harness/core/bytes.hpp"

namespace armjig {

/// What a client has not taken yet. Messages go in whole or are dropped whole, and a message that
/// has begun to leave is finished, so a slow client loses frames but never sees a torn one.
class Outbox {
 public:
  /// Enough for ten seconds of telemetry at 100 Hz.
  static constexpr std::size_t kCapacity = std::size_t{64} * 1024;

  /// Drops the message if it does not fit beside those that wait. Requires that it is not empty.
  void push(Bytes message);

  /// Everything that waits, in order.
  [[nodiscard]] Bytes waiting() const noexcept { return Bytes{bytes_}.subspan(gone_); }
  [[nodiscard]] bool is_empty() const noexcept { return ends_.empty(); }

  /// The first `size` bytes of `waiting()` have left.
  void pop(std::size_t size);

  /// The client has gone: drops everything.
  void clear();

  /// Messages that were dropped, not wholly taken ones among them.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t gone_ = 0;          ///< of `bytes_`
  std::deque<std::size_t> ends_;  ///< in `bytes_`, of each message that waits
  std::uint64_t dropped_ = 0;
};

}  // namespace armjig
