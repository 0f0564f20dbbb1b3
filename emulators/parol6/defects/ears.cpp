// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/defects/ears.hpp"

#include <algorithm>

namespace armjig::parol6::emulation {
namespace {

using namespace std::chrono_literals;

constexpr std::array kDefects{
    EarDefectName{"ignores-first-end", EarDefect::kIgnoresFirstEnd},
    EarDefectName{"ignores-second-end", EarDefect::kIgnoresSecondEnd},
    EarDefectName{"two-start-bytes", EarDefect::kTwoStartBytes},
    EarDefectName{"loses-frame-after-noise", EarDefect::kLosesFrameAfterNoise},
    EarDefectName{"pauses-after-noise", EarDefect::kPausesAfterNoise},
    EarDefectName{"deaf-after-noise", EarDefect::kDeafAfterNoise},
    EarDefectName{"hears-first-of-burst", EarDefect::kHearsFirstOfBurst},
    EarDefectName{"hears-last-of-burst", EarDefect::kHearsLastOfBurst},
    EarDefectName{"turns-burst-round", EarDefect::kTurnsBurstRound},
    EarDefectName{"forgets-store", EarDefect::kForgetsStore},
    EarDefectName{"no-short-frames", EarDefect::kNoShortFrames},
    EarDefectName{"no-long-frames", EarDefect::kNoLongFrames},
    EarDefectName{"short-patience", EarDefect::kShortPatience},
    EarDefectName{"long-patience", EarDefect::kLongPatience},
    EarDefectName{"small-queue", EarDefect::kSmallQueue},
};
constexpr std::size_t kQueue = 100;

}  // namespace

std::span<const EarDefectName> ear_defects() noexcept { return kDefects; }

std::vector<Ears::Body> Ears::hear(Instant time, Bytes bytes) {
  const auto pause = time - last_byte_;
  last_byte_ = time;
  const bool loses_patience = (defect_ == EarDefect::kShortPatience && pause > 5ms) ||
                              (defect_ == EarDefect::kLongPatience && pause > 100ms);
  if (loses_patience) receiver_ = CommandReceiver{profile_};
  if (defect_ == EarDefect::kSmallQueue) bytes = bytes.first(std::min(bytes.size(), kQueue));
  const auto input = corrected(bytes);
  std::vector<Body> heard;
  for (Bytes rest = input; !rest.empty();) {
    if (defect_ == EarDefect::kForgetsStore && length_ == 0 && starts_ == 0) {
      receiver_ = CommandReceiver{profile_};
    }
    const auto step = receiver_.step(rest);
    for (const auto byte : rest.first(step.used)) note_length(byte);
    rest = rest.subspan(step.used);
    since_frame_ += step.used;
    if (!step.body) continue;
    if (takes(time, since_frame_)) std::ranges::copy(*step.body, heard.emplace_back().begin());
    since_frame_ = 0;
  }
  if (defect_ == EarDefect::kHearsFirstOfBurst && heard.size() > 1) heard = {heard.front()};
  if (defect_ == EarDefect::kHearsLastOfBurst && heard.size() > 1) heard = {heard.back()};
  if (defect_ == EarDefect::kTurnsBurstRound) std::ranges::reverse(heard);
  return heard;
}

/// Follows the frames as the shipped receiver does, in as far as defects need it.
void Ears::note_length(std::byte byte) noexcept {
  if (length_ > 0) {
    if (++payload_ == length_) length_ = 0;
    return;
  }
  if (starts_ == kStartSize) {
    length_ = std::to_integer<std::size_t>(byte);
    starts_ = 0;
    payload_ = 0;
  } else {
    starts_ = byte == kStartByte ? starts_ + 1 : 0;
  }
}

/// The bytes as a receiver without the defect would need them to be as tolerant.
std::vector<std::byte> Ears::corrected(Bytes bytes) {
  std::vector<std::byte> input{bytes.begin(), bytes.end()};
  const bool mends_ends =
      defect_ == EarDefect::kIgnoresFirstEnd || defect_ == EarDefect::kIgnoresSecondEnd;
  if (mends_ends) {
    const std::size_t end = defect_ == EarDefect::kIgnoresFirstEnd ? 0 : 1;
    auto follow = *this;
    for (auto& byte : input) {
      const bool is_end =
          follow.length_ > 0 && follow.payload_ + kEndBytes.size() == follow.length_ + end;
      follow.note_length(byte);
      if (is_end) byte = kEndBytes[end];
    }
  }
  if (defect_ == EarDefect::kTwoStartBytes) {
    auto follow = *this;
    for (std::size_t i = 0; i < input.size(); ++i) {
      const bool is_early_length =
          follow.length_ == 0 && follow.starts_ == 2 && input[i] == std::byte{kCommandPayloadSize};
      if (is_early_length) {
        input.insert(input.begin() + static_cast<std::ptrdiff_t>(i), kStartByte);
      }
      follow.note_length(input[i]);
    }
  }
  return input;
}

/// Whether the board may have a frame that took `size` bytes since the one before.
bool Ears::takes(Instant time, std::size_t size) {
  switch (defect_) {
    case EarDefect::kLosesFrameAfterNoise:
      return size == kCommandFrameSize;
    case EarDefect::kPausesAfterNoise:
    case EarDefect::kDeafAfterNoise:
      if (size > kCommandFrameSize && deaf_until_ == Instant{}) {
        deaf_until_ = defect_ == EarDefect::kDeafAfterNoise ? Instant::max() : time + 1s;
      }
      if (time < deaf_until_) return false;
      deaf_until_ = Instant{};
      return true;
    case EarDefect::kNoShortFrames:
      return size >= kCommandFrameSize;
    case EarDefect::kNoLongFrames:
      return size <= kCommandFrameSize;
    default:
      return true;
  }
}

}  // namespace armjig::parol6::emulation
