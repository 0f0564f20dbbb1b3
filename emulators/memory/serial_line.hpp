// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "emulators/memory/hosted.hpp"
#include "harness/core/time.hpp"
#include "harness/link/serial_line.hpp"

namespace armjig {

/// How fast characters pass a serial line.
struct CharacterRate {
  std::uint32_t baud{};     ///< more than 0
  std::uint32_t bits = 10;  ///< of a character, with start, parity and stop bits

  /// Rounded to the nanosecond for each number of characters, so that errors do not add up.
  [[nodiscard]] constexpr Duration time_of(std::uint64_t characters) const noexcept {
    constexpr std::uint64_t kSecond = 1'000'000'000;
    return std::chrono::nanoseconds{(characters * bits * kSecond + baud / 2) / baud};
  }

  friend bool operator==(const CharacterRate&, const CharacterRate&) = default;
};

/// A start bit, eight of data, and what else the line has.
[[nodiscard]] constexpr CharacterRate rate_of(const SerialLine& line) noexcept {
  return {line.baud, 9U + (line.parity == Parity::kNone ? 0U : 1U) + line.stop_bits};
}

/// The device at the end of a serial line, where each character takes its time: the device receives
/// it when its last bit has come, one call for each, and what the device sends comes character by
/// character.
[[nodiscard]] std::unique_ptr<HostedStream> put_on_line(std::unique_ptr<HostedStream> device,
                                                        CharacterRate rate);

}  // namespace armjig
