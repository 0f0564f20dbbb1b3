// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "emulators/parol6/board.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::emulation {

/// What a quirk knows when a frame is heard or answered.
struct Exchange {
  CommandFrame asked{};    ///< as the host sent it
  CommandFrame passed{};   ///< as the board got it
  TelemetryFrame truth{};  ///< as the board answered
  TelemetryFrame said{};   ///< as the host got it
};
struct QuirkMemory {
  Exchange before{};
  Duration gap{};  ///< between the frame and the one before
  std::array<std::int32_t, kJointCount> numbers{};
  bool is_set = false;
};

/// A wrong behaviour, written by hand: it changes what the board hears, or what it says.
struct Quirk {
  std::string_view name;
  std::string_view section;  ///< where docs/spec would have it
  void (*hear)(CommandFrame& frame, QuirkMemory& memory, const Board& board){};
  void (*say)(TelemetryFrame& answer, const CommandFrame& asked, QuirkMemory& memory,
              const Board& board){};
};

/// `rare:NAME`: no suite finds them, and no catalogue names them; they try campaigns.
[[nodiscard]] std::span<const Quirk> rare_quirks() noexcept;
[[nodiscard]] std::span<const Quirk> quirks() noexcept;

}  // namespace armjig::parol6::emulation
