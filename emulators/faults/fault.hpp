// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "harness/core/error.hpp"
#include "harness/wire/field.hpp"

namespace armjig {

/// A defect that a real device could have, put on an emulated one to see it found.
struct Fault {
  enum class Kind : std::uint8_t {
    // Of one field of each message.
    kZero,         ///< always 0
    kStuck,        ///< keeps its first value
    kStale,        ///< has the value of the message before
    kOffByOne,     ///< one too high
    kDoubled,      ///< twice what it should be
    kNegated,      ///< with the other sign
    kSwapBytes,    ///< least significant byte first
    kReverseBits,  ///< the bit order of each byte turned round
    kSwapped,      ///< in the place of another field, and that one in its
    kBitLow,       ///< one bit always 0
    kBitHigh,      ///< one bit always 1
    // Of messages.
    kLate,         ///< each leaves 20 ms late
    kMissing,      ///< one in ten does not leave
    kTwice,        ///< one in ten leaves twice
    kUnasked,      ///< one in ten is repeated 100 ms later
    kCutShort,     ///< one in ten ends a byte early
    kLosesSplits,  ///< one that does not arrive in one piece is lost
  };
  Kind kind{};
  const Field* field{};  ///< none for those of messages
  const Field* other{};  ///< of `kSwapped`
  std::uint8_t bit{};    ///< of `kBitLow` and `kBitHigh`, from 0, the least significant

  [[nodiscard]] bool is_about_field() const noexcept { return field != nullptr; }
};

/// Reads `KIND`, `KIND:FIELD`, `swapped:FIELD+FIELD` or `bit-low:FIELD.BIT`, for example
/// `swap-bytes:speed.j1`. Problems: `kBadValue`.
[[nodiscard]] Outcome<Fault> parse_fault(std::string_view text, std::span<const Field> fields);

/// As `parse_fault` reads it.
[[nodiscard]] std::string to_string(const Fault& fault);

/// The forms that `parse_fault` takes, for help texts.
[[nodiscard]] std::string fault_forms();

/// Changes the field of one message as the fault demands; nothing if it is not about a field or the
/// message is too short. `memory` is for `kStuck` and `kStale`, one for each fault.
void apply_fault(const Fault& fault, std::span<std::byte> message,
                 std::optional<std::int64_t>& memory) noexcept;

}  // namespace armjig
