// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "harness/wire/morap/figures.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::morap::conformance {

/// What a tuning request gives, as it is read back behind a tick.
struct Tuned {
  TuneRequest request;
  std::string_view set;
};

/// A motor that is known, in the bytes that its nodes say. From docs/spec/morap.md.
struct Motor {
  KnownMotor known;
  std::string_view position_set;     ///< stored
  std::string_view speed_set;        ///< stored
  std::string_view one_radian;       ///< the angle behind a calibration to 1 rad
  std::string_view minus_half;       ///< and to -0.52 rad
  std::string_view one_count;        ///< the angle of one count
  std::string_view thousand_counts;  ///< and of a thousand
  int standstill_levels{};           ///< the voltage that drives the rated current at standstill
  std::span<const Tuned> tuned;
};

[[nodiscard]] std::span<const Motor> motors() noexcept;

}  // namespace armjig::morap::conformance
