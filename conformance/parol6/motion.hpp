// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "conformance/parol6/board_bench.hpp"
#include "harness/core/time.hpp"

/// What cases say about joints that move or stand.
namespace armjig::parol6::conformance {

/// By how much a board's time is wrong, which has an RC oscillator: 1 %, and a margin.
inline constexpr double kClockError = 0.02;

/// The first and the last answer of a stretch of time in which a command acted.
struct Stretch {
  Answer before;
  Answer after;
};

/// Steps from the first to the last answer.
[[nodiscard]] std::int32_t steps(const Stretch& stretch, std::size_t joint) noexcept;

/// Lets a command act for a time, repeated every 10 ms; both answers are from while it acts.
Stretch run(BoardBench& board, const CommandFrame& frame, Duration time);

/// Expects the joint to have made the steps of that speed, as far as times and the length of the
/// board's loop (100 us, or up to 250 us if answers take that long) leave it open.
void expect_speed(BoardBench& board, const Stretch& stretch, std::size_t joint, int speed);

/// Expects the joint to have made the steps of the speeds that the answers report, which grow or
/// shrink from one to the next.
void expect_pace(BoardBench& board, std::span<const Answer> answers, std::size_t joint);

/// Leaves the case open if this machine did not ask for more than 100 ms: stages and ramps of
/// `what` may have passed unseen.
void expect_seen(BoardBench& board, std::span<const Answer> answers, std::string_view what);

/// Expects that no joint moves while a frame is repeated for a time.
void expect_still(BoardBench& board, const CommandFrame& frame, Duration time);
/// The same for a stretch that is over.
void expect_still(BoardBench& board, const Stretch& stretch);
/// Expects that at least one joint has moved.
void expect_moved(BoardBench& board, const Stretch& stretch);

/// Disables the board, and nothing of how it stood is taken for granted afterwards.
void spoil_disabled(BoardBench& board);

/// Expects the speeds that telemetry reports.
void expect_reported(BoardBench& board, const Answer& answer, const Speeds& speeds);

/// `speed.j1` and the like.
[[nodiscard]] std::string speed_field(std::size_t joint);
[[nodiscard]] std::string position_field(std::size_t joint);

/// Starts homing and lets it go on for a time. No joint is near its switch by then if the arm stood
/// near its standby position.
void begin_homing(BoardBench& board, Duration time);

/// Pauses homing and gives an answer of an arm that stands, which also a guard has seen by then.
Answer rest_in_homing(BoardBench& board);

/// Homes an arm wherever it is, with one home command and idle frames; a finding if it takes more
/// than 90 s.
void home_by_idling(BoardBench& board);

/// All joints where they are in `answer`, but one further by `steps`.
[[nodiscard]] std::array<Steps, kJointCount> beside(const TelemetryFrame& answer, std::size_t joint,
                                                    int steps);

}  // namespace armjig::parol6::conformance
