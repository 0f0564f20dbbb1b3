// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rapidcheck.h>

#include <cstddef>
#include <cstdint>

#include "harness/link/impairment.hpp"

/// Impairments for properties. To be called inside one.
namespace armjig::test {

/// Whether a defect is there at all.
[[nodiscard]] inline bool is_present() { return *rc::gen::inRange(0, 2) == 1; }

/// 0 to 1, never so small that it does not matter.
[[nodiscard]] inline double any_rate() {
  return is_present() ? *rc::gen::inRange(1, 1001) / 1000.0 : 0;
}

/// Half of them whole milliseconds, so that some things fall on the same time.
[[nodiscard]] inline Duration any_duration(std::int64_t most_microseconds) {
  if (is_present()) {
    return std::chrono::milliseconds{
        *rc::gen::inRange<std::int64_t>(0, most_microseconds / 1000 + 1)};
  }
  return std::chrono::microseconds{*rc::gen::inRange<std::int64_t>(0, most_microseconds + 1)};
}

[[nodiscard]] inline DurationLaw any_law(std::int64_t most_microseconds) {
  const auto first = any_duration(most_microseconds);
  const auto second = any_duration(most_microseconds);
  switch (*rc::gen::inRange(0, 4)) {
    case 1:
      return {DurationLaw::Kind::kUniform, first, first + second};
    case 2:
      return {DurationLaw::Kind::kNormal, first, second};
    case 3:
      return {DurationLaw::Kind::kExponential, first, {}};
    default:
      return {DurationLaw::Kind::kConstant, first, {}};
  }
}

/// Defects that change neither bytes nor their order: splits, merges, delays, bandwidth, stalls.
[[nodiscard]] inline PathImpairment any_harmless_path() {
  using Grouping = PathImpairment::Grouping;
  PathImpairment path;
  if (is_present()) path.chunk = *rc::gen::inRange<std::size_t>(1, 20);
  if (is_present()) path.split = {Grouping::kFixed, *rc::gen::inRange<std::size_t>(1, 20)};
  if (is_present()) path.split = {Grouping::kRandom, 0};
  if (is_present()) {
    path.merge = {Grouping::kFixed, *rc::gen::inRange<std::size_t>(1, 60), any_duration(9'000)};
  }
  if (is_present()) path.merge = {Grouping::kRandom, 0, any_duration(9'000)};
  if (is_present()) path.delay = any_law(9'000);
  if (is_present()) path.bandwidth = *rc::gen::inRange<std::uint64_t>(1, 100'000);
  if (is_present()) path.stall = {*rc::gen::inRange(1, 1001) / 1000.0, any_law(20'000)};
  return path;
}

[[nodiscard]] inline PathImpairment any_path() {
  auto path = any_harmless_path();
  path.bit_errors = any_rate() / 100;
  path.loss = any_rate();
  path.doubling = any_rate();
  if (const auto rate = any_rate(); rate > 0) path.reordering = {rate, any_duration(30'000)};
  path.disconnect = any_rate() / 50;
  if (is_present()) path.disconnect_after = *rc::gen::inRange<std::uint64_t>(1, 500);
  return path;
}

[[nodiscard]] inline Impairment any_impairment() {
  return {any_path(), any_path(), *rc::gen::arbitrary<std::uint64_t>()};
}

}  // namespace armjig::test
