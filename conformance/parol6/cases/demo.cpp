// SPDX-License-Identifier: Apache-2.0
// The demonstration ignores the board's own disable, so no guard lets it pass: these cases run on
// emulated boards only, each on one that was just switched on.
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr int kCode = 69;
constexpr Speeds kOut{6179, -22'222, 49'812, 0, 4059, 46'075};
/// Counters at power-up are 0, so every leg has its way to go. The longest takes
/// 15.2 s, and more on a board with a long loop.
constexpr Duration kLeg = 40s;

/// Asks until an answer takes more than a second, for the board sleeps between its legs. That is
/// how long it took; the answer is the first one behind it.
struct Sleep {
  Answer after;
  Duration length{};
};
Sleep run_out(BoardBench& board) {
  const auto end = board.now() + kLeg;
  while (!board.is_over() && !board.error() && board.now() < end) {
    const auto answer = board.ask(with_code(kCode), 3s);
    const auto length = answer.received - answer.asked;
    if (length > 1s) return {board.ask(with_code(kCode)), length};
    board.pause(BoardBench::kFramePeriod);
  }
  board.fail("a sleep at the end of the first leg", "none within 40 s");
  return {};
}

Answer run_back(BoardBench& board) {
  const auto is_back = [](const Answer& answer) { return answer.position == kStandby; };
  const auto answer = board.ask_until(with_code(kCode), is_back, kLeg);
  if (!answer) board.fail("all joints at their standby positions", "not within 40 s");
  return answer.value_or(Answer{});
}

void both_legs(BoardBench& board) {
  board.spoil();
  const auto out = run_out(board).after;
  board.about("the first answers after the sleep");
  for (std::size_t j = 0; j < kJointCount; ++j) {
    board.expect_between(out, position_field(j), kOut[j] - 40, kOut[j] + 40);
  }
  run_back(board);
}

void unknown(BoardBench& board) {
  board.spoil();
  board.about("code 69");
  expect_still(board, with_code(kCode), 500ms);
}

void disabled(BoardBench& board) {
  board.spoil();
  board.act(with_code(102));
  board.about("code 69 while disabled");
  expect_moved(board, run(board, with_code(kCode), 500ms));
}

void sleeps(BoardBench& board) {
  board.spoil();
  const auto length = run_out(board).length;
  board.expect_true(length > 1900ms && length < 2100ms, "one answer after 2 s",
                    fmt::format("it took {} ms", length / 1ms));
}

void ramp(BoardBench& board) {
  board.spoil();
  const auto has_sped_up = [](const Answer& answer) { return answer.position[0].value > 1000; };
  const auto answer = board.ask_until(with_code(kCode), has_sped_up, 5s);
  board.about("j1 some 1000 steps into the demonstration");
  if (!answer) return board.fail("j1 to go up", "it does not");
  board.expect_between(*answer, "speed.j1", 3400, 3800);
  const auto is_fast = [](const Answer& later) { return later.position[0].value > 3050; };
  const auto fast = board.ask_until(with_code(kCode), is_fast, 5s);
  board.about("j1 half-way in the demonstration");
  if (fast) board.expect_between(*fast, "speed.j1", 5850, 6000);
}

void only_once(BoardBench& board) {
  board.spoil();
  run_out(board);
  run_back(board);
  board.about("code 69 after the end of a demonstration");
  expect_still(board, with_code(kCode), 500ms);
  board.act(idle());
  board.about("code 69 after the end of a demonstration and idle");
  expect_moved(board, run(board, with_code(kCode), 500ms));
}

void interrupted(BoardBench& board) {
  board.spoil();
  board.keep_asking(with_code(kCode), 1s);
  board.act(with_code(42));
  board.about("code 42 in a demonstration");
  expect_still(board, with_code(42), 200ms);
  const auto before = board.ask(with_code(kCode));
  const auto after = board.keep_asking(with_code(kCode), 200ms);
  board.about("code 69 again");
  board.expect_between(after, "position.j3", before.position[2].value + 100, INT32_MAX);
}

void lowers_maximum(BoardBench& board) {
  board.spoil();
  board.keep_asking(with_code(kCode), 100ms);
  board.act(idle());
  constexpr int kFast = 60'000;
  board.act(jog({kFast, -kFast, kFast, -kFast, kFast, -kFast}));
  board.about("a jog at 60,000 after a demonstration");
  expect_reported(board, board.ask(jog({kFast, -kFast, kFast, -kFast, kFast, -kFast})),
                  {6000, -4000, 3500, -3500, 3500, -7500});
}

constexpr Case kCases[] = {
    from(kFresh, Hazard::kMove, "parol6.demo", "All joints go out and come back.", on<both_legs>),
    from(kFresh, Hazard::kMove, "parol6.demo.unknown", "No joint moves with code 69.", on<unknown>),
    from(kFresh, Hazard::kMove, "parol6.demo.disabled", "Joints move with code 69 after disable.",
         on<disabled>),
    from(kFresh, Hazard::kMove, "parol6.demo.sleeps", "One answer between the legs takes 2 s.",
         on<sleeps>),
    from(kFresh, Hazard::kMove, "parol6.demo.ramp",
         "J1 has the speeds of its ramp at 1000 and at 3050 steps.", on<ramp>),
    from(kFresh, Hazard::kMove, "parol6.demo.once",
         "The demonstration runs again only after an idle frame.", on<only_once>),
    from(kFresh, Hazard::kMove, "parol6.demo.interrupted",
         "The demonstration stands while code 42 is sent, and goes on.", on<interrupted>),
    from(kFresh, Hazard::kMove, "parol6.demo.lowers-maximum",
         "Six jogs are clamped to six lower speeds.", on<lowers_maximum>),
};

}  // namespace

std::span<const Case> demo_cases() noexcept { return kCases; }

}  // namespace armjig::parol6::conformance
