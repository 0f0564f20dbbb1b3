// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <cstdlib>

#include "conformance/parol6/board_bench.hpp"
#include "conformance/parol6/chapters.hpp"
#include "conformance/parol6/motion.hpp"

namespace armjig::parol6 {
namespace {

using namespace std::chrono_literals;

using Targets = std::array<Steps, kJointCount>;

constexpr std::size_t kJ4 = 3;
constexpr std::size_t kJ5 = 4;
constexpr std::size_t kJ6 = 5;

/// Longer than the last steps of any go-to take.
constexpr Duration kArrival = 500ms;

Answer expect_arrival(BoardBench& board, const Targets& targets) {
  const auto answer = board.keep_asking(go_to(targets), kArrival);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    board.expect(answer, position_field(j), targets[j].value);
  }
  return answer;
}

void arrives(BoardBench& board) {
  const auto rest = board.ask(idle());
  for (const int way : {90, -90, 1, -1}) {
    board.about(fmt::format("a go-to of {} steps", way));
    expect_arrival(board, beside(rest, kJ5, way));
    expect_still(board, go_to(beside(rest, kJ5, way)), 100ms);
    expect_arrival(board, rest.position);
  }
  board.act(idle());
}

void own_joint(BoardBench& board) {
  const auto rest = board.ask(idle());
  for (std::size_t j = 0; j < kJointCount; ++j) {
    board.about(fmt::format("a go-to of j{}", j + 1));
    expect_arrival(board, beside(rest, j, 50));
    expect_arrival(board, rest.position);
  }
  board.act(idle());
}

void all_together(BoardBench& board) {
  const auto rest = board.ask(idle());
  auto targets = rest.position;
  constexpr Speeds kWays{60, 70, 80, -60, -70, -80};
  for (std::size_t j = 0; j < kJointCount; ++j) targets[j].value += kWays[j];
  expect_arrival(board, targets);
  expect_arrival(board, rest.position);
  board.act(idle());
}

void below_zero(BoardBench& board) {
  const auto rest = board.ask(idle());
  auto targets = rest.position;
  targets[kJ4] = Steps{-70};
  targets[kJ5] = Steps{-3};
  board.about("a go-to of j4 to -70 and j5 to -3");
  expect_arrival(board, targets);
  expect_arrival(board, rest.position);
  board.act(idle());
}

void big_endian(BoardBench& board) {
  const auto rest = board.ask(idle());
  auto targets = rest.position;
  targets[kJ5] = Steps{0x0103};
  targets[kJ6] = Steps{0x007E01};
  board.about("a go-to of j5 to 000103 and of j6 to 007E01");
  expect_arrival(board, targets);
}

constexpr int law(int commanded, int distance) { return (commanded + 100 * distance) / 2; }

/// Telemetry has the speed of a pass and the position after its step, if it made one.
void expect_law(BoardBench& board, const CommandFrame& frame, Duration time) {
  board.act(frame);
  const auto end = board.now() + time;
  while (!board.is_over() && !board.error() && board.now() < end) {
    const auto answer = board.ask(frame);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto distance = frame.position[j].value - answer.position[j].value;
      const auto reported = answer.speed[j].value;
      const auto direction = reported == 0 ? 0 : reported / std::abs(reported);
      const auto now = law(frame.speed[j].value, distance);
      const auto before = law(frame.speed[j].value, distance + direction);
      board.about(fmt::format("a go-to of j{}, {} steps away, commanded speed {}", j + 1, distance,
                              frame.speed[j].value));
      board.expect_true(reported == now || reported == before,
                        fmt::format("speed.j{} = {} or {}", j + 1, now, before),
                        fmt::format("{} steps/s", reported));
    }
    board.pause(3ms);
  }
}

void expect_law(BoardBench& board, const Speeds& ways, const Speeds& speeds) {
  const auto rest = board.ask(idle());
  auto targets = rest.position;
  for (std::size_t j = 0; j < kJointCount; ++j) targets[j].value += ways[j];
  expect_law(board, go_to(targets, speeds), 150ms);
  board.keep_asking(go_to(rest.position), kArrival);
  board.act(idle());
}

void the_law(BoardBench& board) {
  expect_law(board, {100, -100, 1, -1, 3, 0}, {200, -200, 0, 0, -1, 0});
  expect_law(board, {-20, 30, -90, 110, -7, 55}, {0, 1001, -999, 333, 1, -2000});
}

void toward_zero(BoardBench& board) {
  const auto rest = board.ask(idle());
  board.about("a go-to at its target with commanded speeds of 1 and -1");
  const auto stretch = run(board, go_to(rest.position, {1, -1, 1, -1, 1, -1}), 300ms);
  expect_still(board, stretch);
  expect_reported(board, stretch.after, {});
  board.act(idle());
}

void balance(BoardBench& board) {
  const auto rest = board.ask(idle());
  constexpr Speeds kSpeeds{200, -200, 500, -500, 1000, -1000};
  const auto answer = board.keep_asking(go_to(rest.position, kSpeeds), kArrival);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    board.about(fmt::format("a go-to at its target with a commanded speed of {}", kSpeeds[j]));
    board.expect(answer, position_field(j), rest.position[j].value + kSpeeds[j] / 100);
  }
  board.keep_asking(go_to(rest.position), kArrival);
  board.act(idle());
}

void feed(BoardBench& board) {
  const auto rest = board.ask(idle());
  const auto frame = go_to(beside(rest, kJ6, 100), {0, 0, 0, 0, 0, 3000});
  expect_law(board, frame, 20ms);
  board.about("a go-to of 100 steps with a commanded speed of 3000");
  const auto answer = board.keep_asking(frame, kArrival);
  board.expect(answer, "position.j6", rest.position[kJ6].value + 130);
  board.keep_asking(go_to(rest.position), kArrival);
  board.act(idle());
}

void new_target(BoardBench& board) {
  const auto rest = board.ask(idle());
  board.keep_asking(go_to(beside(rest, kJ5, 100)), 20ms);
  board.about("a go-to whose target has changed on the way");
  expect_arrival(board, beside(rest, kJ5, -60));
  expect_arrival(board, rest.position);
  board.act(idle());
}

void no_overshoot(BoardBench& board) {
  const auto rest = board.ask(idle());
  const auto target = rest.position[kJ5].value + 100;
  const auto end = board.now() + 300ms;
  auto last = rest.position[kJ5].value;
  while (!board.is_over() && !board.error() && board.now() < end) {
    const auto answer = board.ask(go_to(beside(rest, kJ5, 100)));
    board.about("a go-to of 100 steps, from answer to answer");
    board.expect_between(answer, "position.j5", last, target);
    last = answer.position[kJ5].value;
    board.pause(3ms);
  }
  board.keep_asking(go_to(rest.position), kArrival);
  board.act(idle());
}

void last_steps(BoardBench& board) {
  const auto rest = board.ask(idle());
  const auto frame = go_to(beside(rest, kJ5, 1));
  board.pause(30ms);
  const auto first = board.act(frame);
  board.about("one step beside the target");
  board.expect(board.ask(frame), "position.j5", rest.position[kJ5].value + 1);
  const auto further = go_to(beside(rest, kJ5, 2));
  board.act(further);
  const auto answer = board.ask(further);
  if (answer.received - first.asked < 15ms) {
    board.about("the next step, less than 15 ms behind the first");
    board.expect(answer, "position.j5", rest.position[kJ5].value + 1);
    board.expect(answer, "speed.j5", 50);
  }
  board.keep_asking(go_to(rest.position), kArrival);
  board.act(idle());
}

void sticky(BoardBench& board) {
  const auto rest = board.act(go_to(beside(board.ask(idle()), kJ5, 80)));
  board.pause(250ms);
  board.about("250 ms after the only frame of a go-to of 80 steps");
  board.expect(board.ask(idle()), "position.j5", rest.position[kJ5].value + 80);
}

void stops(BoardBench& board) {
  const auto rest = board.ask(idle());
  board.act(go_to(beside(rest, kJ5, 100)));
  board.act(idle());
  board.about("idle in the middle of a go-to");
  expect_still(board, idle(), 100ms);
  board.expect_between(board.ask(idle()), "position.j5", rest.position[kJ5].value + 1,
                       rest.position[kJ5].value + 100);
}

void keeps_homed(BoardBench& board) {
  const auto rest = board.ask(idle());
  const auto answer = expect_arrival(board, beside(rest, kJ5, 60));
  board.expect_same(answer, "homed", rest);
  board.act(idle());
}

void expect_far(BoardBench& board, const Speeds& most) {
  board.spoil();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto rest = board.ask(idle());
    for (const int sign : {1, -1}) {
      board.about(fmt::format("a go-to of j{} to a far target", j + 1));
      const auto frame = go_to(beside(rest, j, sign * 100'000));
      const auto stretch = run(board, frame, 20ms);
      board.expect(stretch.after, speed_field(j), std::int64_t{sign} * most[j]);
      expect_speed(board, stretch, j, sign * most[j]);
    }
    board.act(idle());
  }
}

void clamp(BoardBench& board) {
  expect_far(board, {50'000, 50'000, 50'000, 50'000, 50'000, 50'000});
}

void clamp_of_table(BoardBench& board) {
  expect_far(board, {6500, 18'000, 20'000, 22'000, 22'000, 22'000});
}

void unlimited(BoardBench& board) {
  board.spoil();  // a guard would not let it go there; so it is an emulated one
  auto targets = board.ask(idle()).position;
  targets[kJ5] = Steps{6900};
  board.about("a go-to of j5 to 6900");
  board.expect(board.keep_asking(go_to(targets), 3s), "position.j5", 6900);
}

constexpr Case kCases[] = {
    {.requirement = "parol6.goto.arrives",
     .rule = "Four ways of 90 steps and of one step end where they should.",
     .run = on<arrives>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.own-joint",
     .rule = "Six targets move six joints.",
     .run = on<own_joint>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.all-together",
     .rule = "Six joints arrive at six targets of one frame.",
     .run = on<all_together>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.signed",
     .rule = "J4 and J5 can be sent below 0.",
     .run = on<below_zero>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.big-endian",
     .rule = "Targets whose bytes differ are reached.",
     .run = on<big_endian>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.law",
     .rule = "Reported speeds fit reported positions at every answer.",
     .run = on<the_law>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.halved-toward-zero",
     .rule = "Commanded speeds of 1 and -1 move nothing at the target.",
     .run = on<toward_zero>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.balance",
     .rule = "Six joints rest beside their targets, as their speeds say.",
     .run = on<balance>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.feed",
     .rule = "J6 follows the law with a commanded speed of 3000.",
     .run = on<feed>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.new-target",
     .rule = "J5 turns to another target.",
     .run = on<new_target>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.no-overshoot",
     .rule = "J5 comes nearer from answer to answer, and not beyond.",
     .run = on<no_overshoot>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.last-steps",
     .rule = "The second of two single steps does not come within 15 ms.",
     .run = on<last_steps>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.sticky",
     .rule = "One frame brings J5 to its target.",
     .run = on<sticky>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.stops",
     .rule = "Idle stops a go-to on its way.",
     .run = on<stops>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.keeps-homed",
     .rule = "A homed arm is still homed after a go-to.",
     .run = on<keeps_homed>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.clamp",
     .rule = "Each joint runs at 50,000 toward a far target, both ways.",
     .run = on<clamp>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.clamp-of-table",
     .rule = "Each joint runs at its own maximum toward a far target, both ways.",
     .run = on<clamp_of_table>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.goto.unlimited",
     .rule = "J5 arrives at 6900 steps.",
     .run = on<unlimited>,
     .hazard = Hazard::kMove,
     .start = kHomed},
};

}  // namespace

std::span<const Case> go_to_cases() noexcept { return kCases; }

}  // namespace armjig::parol6
