// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "emulators/parol6/command_receiver.hpp"
#include "harness/core/time.hpp"

namespace armjig::parol6::emulation {

/// What may be wrong with the way in which a board receives.
enum class EarDefect : std::uint8_t {
  kNone,
  kIgnoresFirstEnd,       ///< takes any byte for the 01
  kIgnoresSecondEnd,      ///< takes any byte for the 02
  kTwoStartBytes,         ///< two start bytes in front of the length are enough
  kLosesFrameAfterNoise,  ///< a frame with anything in front of it is lost
  kPausesAfterNoise,      ///< after noise it hears nothing for a second
  kDeafAfterNoise,        ///< and this one never again
  kHearsFirstOfBurst,
  kHearsLastOfBurst,
  kTurnsBurstRound,
  kForgetsStore,   ///< what a short frame does not bring is 0
  kNoShortFrames,  ///< lengths below 52 are dropped
  kNoLongFrames,   ///< lengths above 52 are dropped
  kShortPatience,  ///< a pause of 5 ms within a frame loses it
  kLongPatience,   ///< one of 100 ms does
  kSmallQueue,     ///< of bytes that come at once it takes 100
};

struct EarDefectName {
  std::string_view name;
  EarDefect defect;
};
[[nodiscard]] std::span<const EarDefectName> ear_defects() noexcept;

/// The front end of a board: takes what comes and passes on the frames that the board should hear,
/// each whole and by itself.
class Ears {
 public:
  using Body = std::array<std::byte, kCommandBodySize>;

  Ears(EarDefect defect, const BoardProfile& profile) noexcept
      : defect_{defect}, profile_{profile}, receiver_{profile} {}

  [[nodiscard]] std::vector<Body> hear(Instant time, Bytes bytes);

 private:
  [[nodiscard]] std::vector<std::byte> corrected(Bytes bytes);
  [[nodiscard]] bool takes(Instant time, std::size_t size);
  void note_length(std::byte byte) noexcept;

  EarDefect defect_;
  BoardProfile profile_;
  CommandReceiver receiver_;
  Instant last_byte_{};
  std::size_t since_frame_ = 0;  ///< bytes since the last frame
  std::size_t length_ = 0;       ///< of the frame under way; 0: none
  std::size_t starts_ = 0;       ///< start bytes in a row
  std::size_t payload_ = 0;      ///< bytes behind the length
  Instant deaf_until_{};
};

}  // namespace armjig::parol6::emulation
