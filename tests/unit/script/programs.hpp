// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>

#include "harness/motion/parol6/joint_table.hpp"
#include "harness/script/parser.hpp"
#include "harness/script/schedule.hpp"

namespace armjig::script::test {

/// The program of these lines between `Begin()` and `End()`; fails the test if it has errors.
inline Program program_of(std::string_view lines, Dialect dialect) {
  auto program = parse("Begin()\n" + std::string{lines} + "\nEnd()\n", dialect);
  if (!program) {
    ADD_FAILURE() << describe(program.error().front(), "program");
    return {dialect, {{{1, 1}, "Begin()", Begin{}}, {{2, 1}, "End()", End{}}}, {}};
  }
  return *std::move(program);
}

inline constexpr auto kStandby = parol6::kStandby;

/// Its schedule, from standby unless told otherwise; fails the test if there is none.
inline Schedule schedule_of(const Program& program, const InterpreterSettings& settings = {},
                            const parol6::JointSteps& from = kStandby) {
  auto result = schedule(program, settings, from);
  if (!result) ADD_FAILURE() << describe(result.error(), "program");
  return std::move(result).value_or(Schedule{});
}

inline parol6::JointSteps steps(const std::array<int, 6>& values) {
  parol6::JointSteps result;
  for (std::size_t j = 0; j < values.size(); ++j) result[j] = Steps{values[j]};
  return result;
}

}  // namespace armjig::script::test
