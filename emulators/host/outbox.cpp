// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/outbox.hpp"

#include <cassert>

namespace armjig {

void Outbox::push(Bytes message) {
  assert(!message.empty());
  if (waiting().size() + message.size() > kCapacity) {
    ++dropped_;
    return;
  }
  if (bytes_.size() + message.size() > 2 * kCapacity) {
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(gone_));
    for (auto& end : ends_) end -= gone_;
    gone_ = 0;
  }
  bytes_.insert(bytes_.end(), message.begin(), message.end());
  ends_.push_back(bytes_.size());
}

void Outbox::pop(std::size_t size) {
  assert(size <= waiting().size());
  gone_ += size;
  while (!ends_.empty() && ends_.front() <= gone_) ends_.pop_front();
  if (ends_.empty()) {
    bytes_.clear();
    gone_ = 0;
  }
}

void Outbox::clear() {
  dropped_ += ends_.size();
  ends_.clear();
  bytes_.clear();
  gone_ = 0;
}

}  // namespace armjig
