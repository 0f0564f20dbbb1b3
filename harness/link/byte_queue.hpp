// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "harness/core/bytes.hpp"

namespace armjig {

/// Bytes that have arrived, and that nobody asked for yet.
class ByteQueue {
 public:
  /// Keeps the newest `most`, as the queue of a terminal does.
  void add(Bytes bytes, std::size_t most = SIZE_MAX) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    if (bytes_.size() > most) drop(bytes_.size() - most);
  }
  /// As many as there are and `into` has room for.
  std::size_t take(std::span<std::byte> into) {
    const auto size = std::min(into.size(), bytes_.size());
    std::copy_n(bytes_.begin(), size, into.begin());
    drop(size);
    return size;
  }
  void reserve(std::size_t size) { bytes_.reserve(size); }
  void clear() noexcept { bytes_.clear(); }
  [[nodiscard]] bool empty() const noexcept { return bytes_.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return bytes_.size(); }

 private:
  void drop(std::size_t size) {
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size));
  }

  std::vector<std::byte> bytes_;
};

}  // namespace armjig
