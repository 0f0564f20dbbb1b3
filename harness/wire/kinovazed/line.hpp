// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <tl/expected.hpp>
#include <variant>

#include "harness/core/bytes.hpp"
#include "harness/wire/kinovazed/vocabulary.hpp"

/// One line of the KinovaZED protocol: text to meaning and back. Nothing allocates or throws.
namespace armjig::kinovazed {

/// The three numbers of `MoveJoystick`; 400 is full deflection.
struct Deflection {
  std::int32_t x{};
  std::int32_t y{};
  std::int32_t z{};

  friend bool operator==(const Deflection&, const Deflection&) = default;
};

/// Only the argument that the verb has means anything; the others stay as they are made.
struct Command {
  Verb verb{};
  Mode mode{};            ///< of `kSetJoystickMode`
  Objective objective{};  ///< of `kRunObjective`, `kSetActiveObjective`
  Deflection deflection;  ///< of `kMoveJoystick`

  friend bool operator==(const Command&, const Command&) = default;
};

[[nodiscard]] constexpr bool is_stick_at_rest(const Command& command) noexcept {
  return command.verb == Verb::kMoveJoystick && command.deflection == Deflection{};
}
[[nodiscard]] constexpr bool is_steering_mode(const Command& command) noexcept {
  return command.verb == Verb::kSetJoystickMode && command.mode != Mode::kNoMode;
}

/// What `Heartbeat:n` says; every value of the byte can be said.
struct Heartbeat {
  std::uint8_t flags{};  ///< `beat::`

  friend bool operator==(const Heartbeat&, const Heartbeat&) = default;
};

using ServerMessage = std::variant<Event, Heartbeat>;

/// Why a line is not what it should be.
enum class LineFault : std::uint8_t {
  kEmpty,
  kUnknownWord,
  kArgumentCount,
  kNotAMode,
  kNotAnObjective,
  kNotANumber,
  kNumberTooLarge,    ///< outside 32 bits; of a heartbeat: outside a byte
  kBlank,             ///< profile documented: a blank where none belongs
  kNotAscii,          ///< profile documented: a byte outside 20..7E
  kNoCarriageReturn,  ///< from the server: LF without CR
  kTooLong,
};
inline constexpr std::size_t kLineFaultCount = static_cast<std::size_t>(LineFault::kTooLong) + 1;

/// A few words without a full stop, for every fault its own.
[[nodiscard]] std::string_view describe(LineFault fault) noexcept;

/// A line with its CR LF, long enough for each that there is.
class EncodedLine {
 public:
  constexpr void append(std::string_view text) noexcept {
    for (const char c : text) text_[size_++] = c;
  }
  [[nodiscard]] constexpr std::string_view view() const noexcept { return {text_.data(), size_}; }
  [[nodiscard]] Bytes bytes() const noexcept {
    return std::as_bytes(std::span{text_}).first(size_);
  }

 private:
  std::array<char, 64> text_{};
  std::size_t size_ = 0;
};

[[nodiscard]] EncodedLine encode(const Command& command) noexcept;
[[nodiscard]] EncodedLine encode(Event event) noexcept;
[[nodiscard]] EncodedLine encode(Heartbeat heartbeat) noexcept;
[[nodiscard]] EncodedLine encode(const ServerMessage& message) noexcept;

/// Reads what a client said, without its LF. `kFirmware` forgives what the shipped server forgives:
/// blanks around the line and the name, one colon at the end, anything behind the digits of a
/// number. `kDocumented` forgives nothing but a missing CR.
[[nodiscard]] tl::expected<Command, LineFault> decode_command(std::string_view line,
                                                              Profile profile) noexcept;

/// Reads what a server said, without its LF but with the CR before it.
[[nodiscard]] tl::expected<ServerMessage, LineFault> decode_message(std::string_view line) noexcept;

}  // namespace armjig::kinovazed
