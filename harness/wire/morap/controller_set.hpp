// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <variant>

#include "harness/core/bytes.hpp"

namespace armjig::morap {

inline constexpr std::size_t kMostCoefficients = 4;

/// Which loop a set of parameters is for. Other values are possible on the wire and keep their
/// number (morap.program.other-kind).
enum class ControllerKind : std::uint8_t { kPosition = 0, kSpeed = 1 };

/// The coefficients of one filter; the last of them belongs to the newest sample. `count` is what
/// the wire says; values above `kMostCoefficients` exist there, but not in a set that a codec
/// makes.
struct Coefficients {
  std::uint8_t count{};
  std::array<float, kMostCoefficients> values{};
};

/// The parameters of one controller (docs/spec/morap.md).
struct ControllerSet {
  ControllerKind kind{};
  std::uint16_t rate_hz{};
  Coefficients d;    ///< of the measured value
  Coefficients c;    ///< of the reference
  Coefficients f;    ///< of earlier outputs
  float integral{};  ///< gain of the integrator for each sample
};

/// From the kind to the checksum.
inline constexpr std::size_t kSmallestSetSize = 11;
inline constexpr std::size_t kLargestSetSize =
    kSmallestSetSize + std::size_t{3} * 4 * kMostCoefficients;
using SetBytes = BoundedBytes<kLargestSetSize>;

/// Bytes of the set on the wire, checksum included. Requires counts of at most four.
[[nodiscard]] std::size_t wire_size(const ControllerSet& set) noexcept;

/// The checksum over a set without its last byte: the sum, folded into eight bits until no carry is
/// left, and complemented.
[[nodiscard]] std::uint8_t checksum(Bytes payload) noexcept;

/// The set as it is sent and read back, with its checksum. Requires counts of at most four.
[[nodiscard]] SetBytes encode(const ControllerSet& set) noexcept;

/// The same into `out`, which is `wire_size(set)` long.
void encode_into(std::span<std::byte> out, const ControllerSet& set) noexcept;

/// Why bytes are not a set.
struct SetFault {
  enum class Kind : std::uint8_t { kTooShort, kCountAboveFour, kWrongChecksum };
  Kind kind{};
  std::size_t offset{};  ///< of the first missing or wrong byte

  friend bool operator==(const SetFault&, const SetFault&) = default;
};

/// Reads the set at the beginning of `in`; bytes behind its checksum are left alone. Judges as the
/// node does: a count as soon as it comes, the checksum last.
[[nodiscard]] std::variant<ControllerSet, SetFault> decode_set(Bytes in) noexcept;

/// The same into `out`, which is half read after a fault.
[[nodiscard]] std::optional<SetFault> decode_into(ControllerSet& out, Bytes in) noexcept;

}  // namespace armjig::morap
