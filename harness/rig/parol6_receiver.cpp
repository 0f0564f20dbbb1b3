// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/parol6_receiver.hpp"

namespace armjig::parol6::rig {

bool ShippedReceiver::take(std::byte byte) noexcept {
  if (header_size_ < kStartSize) {
    header_size_ = byte == kStartByte ? header_size_ + 1 : 0;
    return false;
  }
  if (header_size_ < kHeaderSize) {
    length() = byte;
    filled() = {};
    ++header_size_;
    return false;
  }
  const auto place = std::to_integer<std::size_t>(filled());
  const auto last = std::to_integer<std::size_t>(length());
  memory_[1 + place] = byte;
  if (place + 1 != last) {
    filled() = static_cast<std::byte>(place + 1);
    return false;
  }
  const bool ends_well = memory_[last - 1] == kEndBytes[0] && memory_[last] == kEndBytes[1];
  length() = filled() = {};
  header_size_ = 0;
  return ends_well;
}

}  // namespace armjig::parol6::rig
