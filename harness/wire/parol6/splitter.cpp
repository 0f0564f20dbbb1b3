// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/splitter.hpp"

#include <algorithm>
#include <cstring>

namespace armjig::parol6 {
namespace {

/// The first place in `in` where a frame starts or may start at its end; `in.size()` if none.
std::size_t find_start(Bytes in) noexcept {
  std::size_t place = 0;
  while (place < in.size()) {
    const auto* hit = static_cast<const std::byte*>(
        std::memchr(in.data() + place, std::to_integer<int>(kStartByte), in.size() - place));
    if (hit == nullptr) return in.size();
    place = static_cast<std::size_t>(hit - in.data());
    const auto run = in.subspan(place, std::min(kStartSize, in.size() - place));
    const auto other = std::ranges::find_if(run, [](std::byte b) { return b != kStartByte; });
    if (other == run.end()) return place;
    place += static_cast<std::size_t>(other - run.begin()) + 1;
  }
  return in.size();
}

/// Whether a frame starts where `in` begins, as far as it goes.
bool may_start(Bytes in) noexcept {
  const auto run = in.first(std::min(kStartSize, in.size()));
  return std::ranges::all_of(run, [](std::byte b) { return b == kStartByte; });
}

bool is_one_more_start_byte(const Splitter::Fault& fault) noexcept {
  return fault.kind == Splitter::FaultKind::kWrongLength &&
         fault.value == std::to_integer<std::uint8_t>(kStartByte);
}

}  // namespace

std::byte Splitter::length_byte() const noexcept {
  return static_cast<std::byte>(frame_size_ - kHeaderSize);
}

/// Judges what is there of a candidate: its header as soon as that is complete, its tail when all
/// has come. Monostate means good so far.
std::variant<std::monostate, Splitter::Frame, Splitter::Fault> Splitter::judge(
    Bytes candidate) const noexcept {
  const auto fault = [](FaultKind kind, std::byte value) {
    return Fault{kind, std::to_integer<std::uint8_t>(value)};
  };
  if (candidate.size() < kHeaderSize) return {};
  const auto length = candidate[kStartSize];
  if (length != length_byte()) return fault(FaultKind::kWrongLength, length);
  if (candidate.size() < frame_size_) return {};
  const auto tail = candidate.subspan(frame_size_ - 3, 3);
  if (tail[1] != kEndBytes[0]) return fault(FaultKind::kWrongEnd, tail[1]);
  if (tail[2] != kEndBytes[1]) return fault(FaultKind::kWrongEnd, tail[2]);
  if (!allows(check_, std::to_integer<std::uint8_t>(tail[0]))) {
    return fault(FaultKind::kWrongCheck, tail[0]);
  }
  return Frame{candidate.first(frame_size_)};
}

/// Where in a rejected candidate the next one may start. Headers that are complete and wrong inside
/// it belong to the same fault.
std::size_t Splitter::next_candidate(Bytes rejected) const noexcept {
  for (std::size_t place = 1; place < rejected.size(); ++place) {
    const auto rest = rejected.subspan(place);
    if (!may_start(rest)) continue;
    if (rest.size() < kHeaderSize || rest[kStartSize] == length_byte()) return place;
  }
  return rejected.size();
}

void Splitter::hold(Bytes rest) noexcept {
  std::memmove(buffer_.data(), rest.data(), rest.size());
  held_ = rest.size();
}

Splitter::Step Splitter::step(Bytes in) noexcept {
  if (in.empty()) return {};
  return held_ == 0 ? step_direct(in) : step_held(in);
}

Splitter::Step Splitter::step_direct(Bytes in) noexcept {
  std::size_t place = 0;
  for (;;) {
    place += find_start(in.subspan(place));
    const auto candidate = in.subspan(place, std::min(frame_size_, in.size() - place));
    auto found = judge(candidate);
    if (const auto* fault = std::get_if<Fault>(&found)) {
      if (is_one_more_start_byte(*fault)) {
        ++place;
        continue;
      }
      const auto rejected =
          fault->kind == FaultKind::kWrongLength ? candidate.first(kHeaderSize) : candidate;
      return {place + next_candidate(rejected), found};
    }
    // Made here: copying what `judge` has just written would stall the processor.
    if (std::holds_alternative<Frame>(found)) return {place + frame_size_, Frame{candidate}};
    hold(candidate);
    return {in.size(), {}};
  }
}

/// Completes a candidate that began in an earlier call.
Splitter::Step Splitter::step_held(Bytes in) noexcept {
  std::size_t used = 0;
  while (held_ > 0) {
    const auto wanted = held_ < kHeaderSize ? kHeaderSize : frame_size_;
    const auto taken = std::min(wanted - held_, in.size() - used);
    std::memcpy(buffer_.data() + held_, in.data() + used, taken);
    held_ += taken;
    used += taken;
    // A header that was found right is not judged again.
    if (held_ > kHeaderSize && held_ < frame_size_) return {used, {}};
    const auto candidate = Bytes{buffer_}.first(held_);
    if (!may_start(candidate)) {  // a run of start bytes broke off
      hold(candidate.subspan(next_candidate(candidate)));
      continue;
    }
    auto found = judge(candidate);
    if (const auto* fault = std::get_if<Fault>(&found)) {
      const bool is_longer_run = is_one_more_start_byte(*fault);
      hold(candidate.subspan(is_longer_run ? 1 : next_candidate(candidate)));
      if (is_longer_run) continue;
      return {used, found};
    }
    if (std::holds_alternative<Frame>(found)) {
      held_ = 0;
      return {used, found};
    }
    if (used == in.size()) return {used, {}};
  }
  auto rest = step_direct(in.subspan(used));
  rest.used += used;
  return rest;
}

}  // namespace armjig::parol6
