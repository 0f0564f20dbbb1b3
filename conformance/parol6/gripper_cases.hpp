// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/parol6/cases.hpp"

/// What the cases about the gripper have in common.
namespace armjig::parol6::conformance {

inline constexpr auto kHidden =
    "the CAN between board and gripper cannot be seen on the serial link";

inline constexpr auto kGo =
    static_cast<std::uint8_t>(gripper_command::kActivate | gripper_command::kGoTo);

/// The whole way takes 0.56 s at speed byte 60, 1.6 s at 20.
inline constexpr Duration kWholeWay = 2500ms;

inline constexpr auto kFull = Tier::kFull;

inline GripperSetPoint to(int position, int speed = 60, int current = 400) {
  return {.position = static_cast<std::int16_t>(position),
          .speed = static_cast<std::int16_t>(speed),
          .current = Milliamperes{static_cast<std::int16_t>(current)},
          .command = kGo};
}

inline GripperSetPoint in_mode(GripperSetPoint set_point, int mode) {
  set_point.mode = static_cast<std::uint8_t>(mode);
  return set_point;
}

inline bool is_calibrated(const Answer& answer) {
  return (answer.gripper.status & gripper_status::kCalibrated) != 0;
}

/// What telemetry shows before the gripper has said anything.
inline bool is_untold(const Answer& answer) {
  return answer.gripper.position == 0 && answer.gripper.current == Milliamperes{2} &&
         answer.gripper.status == 1;
}

/// The position, as the answer after the next one shows it: the gripper answers in between.
inline int position(BoardBench& board, const GripperSetPoint& set_point) {
  board.act(with_gripper(set_point));
  return board.ask(with_gripper(set_point)).gripper.position;
}

/// Calibrates the gripper, stands it at `place`. An active one cannot be taken for none. Leaves the
/// case open if there is no gripper.
inline void prepare(BoardBench& board, int place) {
  const GripperSetPoint active{.command = gripper_command::kActivate};
  board.act(with_gripper(active));
  const auto answer = board.act(with_gripper(active));
  if (is_untold(answer)) return board.leave_open("no gripper answers on the board's CAN");
  if (!is_calibrated(answer)) {
    board.act(with_gripper({.mode = gripper_mode::kCalibrate}));
    board.about("a calibration");
    if (!board.ask_until(idle(), is_calibrated, 35s)) {
      board.fail("gripper.status with bit 01 within 35 s", "never");
    }
  }
  board.keep_asking(with_gripper(to(place)), kWholeWay);
}

inline void expect_at(BoardBench& board, const Answer& answer, int position) {
  board.expect_between(answer, "gripper.position", position - 1, position + 1);
}

inline void expect_stands(BoardBench& board, const GripperSetPoint& set_point) {
  const auto before = position(board, set_point);
  board.keep_asking(with_gripper(set_point), 300ms);
  board.expect(board.ask(with_gripper(set_point)), "gripper.position", before);
}

/// The gripper closes on something at 100.
inline Answer hold(BoardBench& board, int current) {
  prepare(board, 0);
  board.touch("between-fingers", 100);
  const auto answer = board.keep_asking(with_gripper(to(255, 60, current)), kWholeWay);
  board.spoil();
  board.about(fmt::format("something held with {} mA", current));
  return answer;
}

constexpr Case grip(std::string_view rule, CaseBody run, Tier tier = Tier::kQuick) {
  auto one = from(kEnabled, Hazard::kGrip, rule, run);
  one.tier = tier;
  return one;
}

constexpr Case with(Case one, Start start) {
  one.start = start;
  return one;
}

}  // namespace armjig::parol6::conformance
