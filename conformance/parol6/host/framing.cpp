// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/host/framing.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "harness/core/hex.hpp"
#include "harness/wire/parol6/dissector.hpp"

namespace armjig::parol6::programs {
namespace {

/// So many bytes end whatever a receiver is in (parol6.receive.length-zero).
constexpr std::size_t kFlushSize = 256;

std::size_t start_in(Bytes bytes) noexcept {
  const auto at = std::search_n(bytes.begin(), bytes.end(), kStartSize, kStartByte);
  return static_cast<std::size_t>(at - bytes.begin());
}

std::string excerpt(Bytes bytes) {
  constexpr std::size_t kShown = 8;
  return to_hex_dump(bytes.first(std::min(bytes.size(), kShown))) +
         (bytes.size() > kShown ? " ..." : "");
}

}  // namespace

Framing::Framing(Complain complain, Duration noise)
    : complain_{std::move(complain)}, most_{kFramePeriod + noise}, dissector_{make_dissector()} {}

void Framing::feed(Instant time, Bytes bytes, const OnFrame& on_frame) {
  messages_.clear();
  if (unfinished_ == 0) begun_ = time;
  unfinished_ += bytes.size();
  dissector_->feed(Direction::kToDevice, time, bytes, messages_);
  for (std::size_t i = 0; i < messages_.size(); ++i) {
    const auto& message = messages_[i];
    unfinished_ -= message.raw.size();
    if (message.fault.empty()) {
      judge_duration(time);
      excused_ = 0;
      has_flushed_ = false;
      on_frame(decode_command(body_of(Bytes{message.raw}.first<kCommandFrameSize>())));
    } else {
      judge_noise(message.raw, i + 1 < messages_.size() && messages_[i + 1].fault.empty());
    }
    begun_ = time;
  }
}

void Framing::judge_duration(Instant time) {
  const auto duration = time - begun_;
  if (duration <= most_) return;
  complain_("parol6.host.frame-prompt",
            fmt::format("a frame took {:.1f} ms to come",
                        std::chrono::duration<double, std::milli>{duration}.count()),
            {.since = begun_, .beyond = duration - most_});
}

/// What a strict receiver passes over: perhaps stray bytes, then perhaps a broken frame.
void Framing::judge_noise(Bytes noise, bool is_before_frame) {
  const auto start = start_in(noise);
  const bool has_header = start + kHeaderSize <= noise.size();
  judge_stray(noise.first(has_header ? start : noise.size()), is_before_frame && !has_header);
  if (!has_header) return;
  const auto frame = noise.subspan(start);
  const auto length = std::to_integer<std::size_t>(frame[kStartSize]);
  if (frame[kStartSize] == kStartByte) {  // a run of start bytes, which ends later
    judge_stray(frame, is_before_frame);
  } else if (length != kCommandPayloadSize) {
    complain_("parol6.host.frame-length", fmt::format("a frame had the length {}", length));
    const auto rest = frame.subspan(kHeaderSize);
    excused_ = length - std::min(length, rest.size());
    if (rest.size() > length) judge_noise(rest.subspan(length), is_before_frame);
  } else if (frame.size() < kCommandFrameSize) {
    complain_("parol6.host.frame-whole",
              fmt::format("a frame ended after {} of {} bytes", frame.size(), kCommandFrameSize));
  } else {
    complain_("parol6.host.frame-end",
              fmt::format("a frame ended with {}",
                          to_hex_dump(frame.subspan(kCommandFrameSize - kEndBytes.size(),
                                                    kEndBytes.size()))));
    judge_stray(frame.subspan(kCommandFrameSize), is_before_frame);
  }
}

/// Many equal bytes, or what clears the store after them: a whole one that is not accepted.
bool Framing::is_reset(Bytes stray) {
  const auto are = [](Bytes bytes, std::byte value) {
    return std::ranges::all_of(bytes, [value](std::byte byte) { return byte == value; });
  };
  if (has_flushed_ && stray.size() == kHeaderSize + kLongestPayload) {
    return are(stray.first(kHeaderSize), kStartByte) && are(stray.subspan(kHeaderSize), {});
  }
  if (stray.size() < kFlushSize || stray[0] == kStartByte) return false;
  has_flushed_ = are(stray, stray[0]);
  return has_flushed_;
}

void Framing::judge_stray(Bytes stray, bool is_before_frame) {
  const auto excused = std::min(excused_, stray.size());
  excused_ -= excused;
  stray = stray.subspan(excused);
  if (stray.empty() || is_reset(stray)) return;
  if (is_before_frame && stray.back() == kStartByte) {
    complain_("parol6.host.stray-start", fmt::format("{} in front of a frame", excerpt(stray)));
  } else {
    complain_("parol6.host.stray-bytes",
              fmt::format("{} bytes between frames: {}", stray.size(), excerpt(stray)));
  }
}

}  // namespace armjig::parol6::programs
