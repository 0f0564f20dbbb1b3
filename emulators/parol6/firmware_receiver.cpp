// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/firmware_receiver.hpp"

#include <algorithm>
#include <cstring>

namespace armjig::parol6::emulation {

FirmwareReceiver::Step FirmwareReceiver::step(Bytes in) noexcept {
  std::size_t used = 0;
  while (used < in.size()) {
    const auto rest = in.subspan(used);
    if (!in_payload_) {
      used += read_header(rest);
      continue;
    }
    const auto payload = read_payload(rest);
    used += payload.used;
    if (payload.accepted) return {used, true};
  }
  return {used, false};
}

std::size_t FirmwareReceiver::read_header(Bytes in) noexcept {
  if (start_bytes_ == 0) {
    const auto* start = std::memchr(in.data(), std::to_integer<int>(kStartByte), in.size());
    if (start == nullptr) return in.size();
    start_bytes_ = 1;
    return static_cast<std::size_t>(static_cast<const std::byte*>(start) - in.data()) + 1;
  }
  if (start_bytes_ < kStartSize) {
    start_bytes_ = in[0] == kStartByte ? start_bytes_ + 1 : 0;
    return 1;
  }
  length_ = std::to_integer<std::uint8_t>(in[0]);  // parol6.receive.any-length: 0xFF included
  filled_ = 0;
  in_payload_ = true;
  return 1;
}

FirmwareReceiver::Step FirmwareReceiver::read_payload(Bytes in) noexcept {
  // parol6.receive.length-zero: the end test never matches, so the store fills up, and the byte
  // behind it is the length itself.
  const std::size_t room = length_ == 0 ? store_.size() : length_;
  const auto taken = std::min(room - filled_, in.size());
  std::memcpy(store_.data() + filled_, in.data(), taken);
  if (length_ == 0) {
    filled_ = static_cast<std::uint8_t>(filled_ + taken);
    if (taken == in.size()) return {taken, false};
    length_ = std::to_integer<std::uint8_t>(in[taken]);
    filled_ = 0;
    return {taken + 1, false};
  }
  filled_ = static_cast<std::uint8_t>(filled_ + taken);
  if (filled_ < length_) return {taken, false};
  const bool accepted = ends_well();
  expect_header();
  return {taken, accepted};
}

bool FirmwareReceiver::ends_well() const noexcept {
  // parol6.receive.length-one: the first end byte would be the one in front of the store, which is
  // the fill counter and 0 at that moment.
  if (length_ < kEndBytes.size()) return false;
  return std::ranges::equal(std::span{store_}.subspan(length_ - kEndBytes.size(), kEndBytes.size()),
                            kEndBytes);
}

void FirmwareReceiver::expect_header() noexcept {
  in_payload_ = false;
  start_bytes_ = 0;
  length_ = 0;
  filled_ = 0;
}

}  // namespace armjig::parol6::emulation
