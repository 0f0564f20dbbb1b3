// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/kinovazed/line_receiver.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace armjig::kinovazed {

LineReceiver::LineReceiver(Profile profile) noexcept
    : rules_{profile == Profile::kFirmware ? kFirmwareRules : kDocumentedRules} {}

LineReceiver::LineReceiver(const LineReceiver& other) noexcept : rules_{other.rules_} {
  *this = other;
}

LineReceiver& LineReceiver::operator=(const LineReceiver& other) noexcept {
  rules_ = other.rules_;
  begin_ = other.begin_;
  size_ = other.size_;
  collected_size_ = other.collected_size_;
  line_ = {};  // not valid in a copy: the next `step` finds the next line
  read_ = other.read_;
  collected_ = other.collected_;
  return *this;
}

void LineReceiver::fill(Bytes bytes) noexcept {
  assert(bytes.size() <= room());
  if (begin_ + size_ + bytes.size() > read_.size()) {
    std::copy_n(read_.begin() + static_cast<std::ptrdiff_t>(begin_), size_, read_.begin());
    begin_ = 0;
  }
  if (!bytes.empty()) std::memcpy(read_.data() + begin_ + size_, bytes.data(), bytes.size());
  size_ += bytes.size();
}

LineReceiver::Found LineReceiver::step() noexcept {
  const char* const text = read_.data() + begin_;
  const auto* const end =
      size_ == 0 ? nullptr : static_cast<const char*>(std::memchr(text, '\n', size_));
  if (end == nullptr) {
    if (size_ < rules_.read_size) return Found::kNothing;
    if (collected_size_ >= rules_.collect_below) {
      collected_size_ = 0;
      drop(size_);
      return Found::kTooLong;
    }
    std::copy_n(text, size_, collected_.data() + collected_size_);
    collected_size_ += size_;
    drop(size_);
    return Found::kNothing;
  }
  const auto length = static_cast<std::size_t>(end - text);
  line_ = {text, length};
  if (collected_size_ > 0) {
    std::copy_n(text, length, collected_.data() + collected_size_);
    line_ = {collected_.data(), collected_size_ + length};
    collected_size_ = 0;
  }
  const bool takes_next = rules_.lf_first_takes_next && length == 0 && size_ > 1;
  drop(length + (takes_next ? 2 : 1));
  return Found::kLine;
}

void LineReceiver::end_of_stream() noexcept {
  drop(size_);
  if (!rules_.keeps_collected) collected_size_ = 0;
}

void LineReceiver::drop(std::size_t count) noexcept {
  size_ -= count;
  begin_ = size_ == 0 ? 0 : begin_ + count;
}

}  // namespace armjig::kinovazed
