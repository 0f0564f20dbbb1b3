// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "harness/wire/morap/controller_set.hpp"

namespace armjig::morap::emulation {

/// The node's reader of a parameter message, byte by byte. What it has read of an unfinished
/// message stays in the set that it writes to, every byte until its own comes.
class ParameterParser {
 public:
  enum class Verdict : std::uint8_t { kGoesOn, kAccepted, kRefused };

  /// The first payload byte always begins a new message.
  void begin() noexcept { *this = ParameterParser{}; }

  /// Takes the next payload byte. After a verdict all further bytes are ignored until `begin`.
  Verdict step(std::byte byte, ControllerSet& staging) noexcept;

 private:
  enum class Part : std::uint8_t { kKind, kRate, kCount, kCoefficients, kIntegral, kCheck, kDone };

  Verdict take_count(std::byte byte, ControllerSet& staging) noexcept;
  void take_coefficient(std::byte byte, ControllerSet& staging) noexcept;
  void next(Part part) noexcept;
  void next_filter() noexcept;

  Part part_ = Part::kKind;
  std::size_t filter_ = 0;  ///< d, c or f
  std::size_t place_ = 0;   ///< bytes of the part that were read
};

}  // namespace armjig::morap::emulation
