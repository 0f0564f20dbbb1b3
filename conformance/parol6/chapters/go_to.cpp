// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

using Targets = std::array<Steps, kJointCount>;

/// Longer than the last steps of any go-to take.
constexpr Duration kArrival = 500ms;

Answer expect_arrival(BoardBench& board, const Targets& targets) {
  const auto answer = board.keep_asking(go_to(targets), kArrival);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    board.expect(answer, position_field(j), targets[j].value);
  }
  return answer;
}

/// Back, at the end of a case.
void expect_return(BoardBench& board, const Answer& rest) {
  expect_arrival(board, rest.position);
  board.act(idle());
}

void go_back(BoardBench& board, const Answer& rest) {
  board.keep_asking(go_to(rest.position), kArrival);
  board.act(idle());
}

Targets beside(const Answer& rest, const Speeds& ways) {
  auto targets = rest.position;
  for (std::size_t j = 0; j < kJointCount; ++j) targets[j].value += ways[j];
  return targets;
}

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
      const auto now = go_to_speed(frame.speed[j].value, distance);
      const auto before = go_to_speed(frame.speed[j].value, distance + direction);
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
  expect_law(board, go_to(beside(rest, ways), speeds), 150ms);
  go_back(board, rest);
}

/// Joints that are sent where they stand rest a hundredth of their commanded speeds beyond.
void expect_balance(BoardBench& board, const Answer& rest, const Speeds& speeds) {
  const auto answer = board.keep_asking(go_to(rest.position, speeds), kArrival);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    board.expect(answer, position_field(j), rest.position[j].value + speeds[j] / 100);
  }
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

constexpr Clause kGoToClauses[] = {
    must("parol6.goto.arrives",
         "A go-to without commanded speeds ends exactly at its target and stays there.",
         "document, following law; firmware"),
    from(kHomed, Hazard::kMove, "Four ways of 90 steps and of one step end where they should.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           for (const int way : {90, -90, 1, -1}) {
             board.about(fmt::format("a go-to of {} steps", way));
             expect_arrival(board, beside(rest, kJ5, way));
             expect_still(board, go_to(beside(rest, kJ5, way)), 100ms);
             expect_arrival(board, rest.position);
           }
           board.act(idle());
         }),

    must("parol6.goto.own-joint",
         "The position field of a joint is the target of that joint and of no other.",
         "document, packet table; firmware"),
    from(kHomed, Hazard::kMove, "Six targets move six joints.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           for (std::size_t j = 0; j < kJointCount; ++j) {
             board.about(fmt::format("a go-to of j{}", j + 1));
             expect_arrival(board, beside(rest, j, 50));
             expect_arrival(board, rest.position);
           }
           board.act(idle());
         }),

    must("parol6.goto.all-together", "In a go-to all joints run at once.", "firmware"),
    from(kHomed, Hazard::kMove, "Six joints arrive at six targets of one frame.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           expect_arrival(board, beside(rest, {60, 70, 80, -60, -70, -80}));
           expect_return(board, rest);
         }),

    must("parol6.goto.signed", "Targets are signed: a joint can be sent below 0.", "firmware"),
    from(kHomed, Hazard::kMove, "J4 and J5 can be sent below 0.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           auto targets = rest.position;
           targets[kJ4] = Steps{-70};
           targets[kJ5] = Steps{-3};
           board.about("a go-to of j4 to -70 and j5 to -3");
           expect_arrival(board, targets);
           expect_return(board, rest);
         }),

    must("parol6.goto.big-endian", "Targets have 24 bits, most significant byte first.",
         "firmware"),
    from(kHomed, Hazard::kMove, "Targets whose bytes differ are reached.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           auto targets = rest.position;
           targets[kJ5] = Steps{0x0103};
           targets[kJ6] = Steps{0x007E01};
           board.about("a go-to of j5 to 000103 and of j6 to 007E01");
           expect_arrival(board, targets);
         }),

    must("parol6.goto.law",
         "The speed of a go-to is the mean of the commanded speed and of 100 times the distance, "
         "halved toward zero, recomputed in every pass.",
         "firmware, vector B12, and the document's description"),
    from(kHomed, Hazard::kMove, "Reported speeds fit reported positions at every answer.",
         [](BoardBench& board) {
           expect_law(board, {100, -100, 1, -1, 3, 0}, {200, -200, 0, 0, -1, 0});
           expect_law(board, {-20, 30, -90, 110, -7, 55}, {0, 1001, -999, 333, 1, -2000});
         }),

    must("parol6.goto.halved-toward-zero",
         "At its target a joint with a commanded speed of 1 or -1 stands still.",
         "firmware: integer division cuts off toward zero"),
    from(kHomed, Hazard::kMove, "Commanded speeds of 1 and -1 move nothing at the target.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           board.about("a go-to at its target with commanded speeds of 1 and -1");
           const auto stretch = run(board, go_to(rest.position, {1, -1, 1, -1, 1, -1}), 300ms);
           expect_still(board, stretch);
           expect_reported(board, stretch.after, {});
           board.act(idle());
         }),

    must("parol6.goto.balance",
         "A joint whose commanded speed leads away from its target rests where the two balance, a "
         "hundredth of that speed beyond.",
         "arithmetic: commanded speed + 100 * distance = 0"),
    from(kHomed, Hazard::kMove, "Six joints rest beside their targets, as their speeds say.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           board.about("a go-to at its target with commanded speeds");
           expect_balance(board, rest, {200, -200, 500, -500, 1000, -1000});
           go_back(board, rest);
         }),

    must("parol6.goto.feed", "A commanded speed along the way makes a go-to faster by its half.",
         "firmware, and the document's description"),
    from(kHomed, Hazard::kMove, "J6 follows the law with a commanded speed of 3000.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           const auto frame = go_to(beside(rest, kJ6, 100), {0, 0, 0, 0, 0, 3000});
           expect_law(board, frame, 20ms);
           board.about("a go-to of 100 steps with a commanded speed of 3000");
           const auto answer = board.keep_asking(frame, kArrival);
           board.expect(answer, "position.j6", rest.position[kJ6].value + 130);
           go_back(board, rest);
         }),

    must("parol6.goto.new-target", "Another target on the way takes effect with its frame.",
         "firmware"),
    from(kHomed, Hazard::kMove, "J5 turns to another target.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           board.keep_asking(go_to(beside(rest, kJ5, 100)), 20ms);
           board.about("a go-to whose target has changed on the way");
           expect_arrival(board, beside(rest, kJ5, -60));
           expect_return(board, rest);
         }),
    variant("speed", from(kHomed, Hazard::kMove, "Only the commanded speeds change.",
                          [](BoardBench& board) {
                            const auto rest = board.ask(idle());
                            board.keep_asking(go_to(rest.position), 50ms);
                            board.about("a go-to whose commanded speeds have changed");
                            expect_balance(board, rest, {1000, -500, 200, -1000, 500, -200});
                            expect_balance(board, rest, {-200, 1000, -500, 200, -1000, 500});
                            go_back(board, rest);
                          })),

    must("parol6.goto.no-overshoot",
         "A go-to without commanded speeds does not go beyond its target.",
         "arithmetic: the last steps are made at 50 steps/s"),
    from(kHomed, Hazard::kMove, "J5 comes nearer from answer to answer, and not beyond.",
         [](BoardBench& board) {
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
           go_back(board, rest);
         }),

    must("parol6.goto.last-steps",
         "Near its target a joint takes its last step at 50 steps/s, 20 ms after the one before or "
         "later.",
         "firmware, vector B13"),
    from(kHomed, Hazard::kMove, "The second of two single steps does not come within 15 ms.",
         [](BoardBench& board) {
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
             board.about("the next step, less than 15 ms after the first");
             board.expect(answer, "position.j5", rest.position[kJ5].value + 1);
             board.expect(answer, "speed.j5", 50);
           }
           go_back(board, rest);
         }),

    must("parol6.goto.sticky", "One frame of a go-to is enough to arrive.",
         "firmware: the last command byte is kept"),
    from(kHomed, Hazard::kMove, "One frame brings J5 to its target.",
         [](BoardBench& board) {
           const auto rest = board.act(go_to(beside(board.ask(idle()), kJ5, 80)));
           board.pause(250ms);
           board.about("250 ms after the only frame of a go-to of 80 steps");
           board.expect(board.ask(idle()), "position.j5", rest.position[kJ5].value + 80);
         }),

    must("parol6.goto.stops", "An idle frame stops a go-to where it is.", "firmware"),
    from(kHomed, Hazard::kMove, "Idle stops a go-to on its way.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           board.act(go_to(beside(rest, kJ5, 100)));
           board.act(idle());
           board.about("idle in the middle of a go-to");
           expect_still(board, idle(), 100ms);
           const auto after = board.ask(idle());
           for (std::size_t j = 0; j < kJointCount; ++j) {
             const auto place = rest.position[j].value;
             if (j == kJ5) {
               board.expect_between(after, position_field(j), place + 1, place + 100);
             } else {
               board.expect(after, position_field(j), place);
             }
           }
         }),

    must("parol6.goto.keeps-homed", "A go-to leaves the homed bits as they are.", "firmware"),
    from(kHomed, Hazard::kMove, "A homed arm is still homed after a go-to.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           const auto answer = expect_arrival(board, beside(rest, kJ5, 60));
           board.expect_same(answer, "homed", rest);
           board.act(idle());
         }),

    must("parol6.goto.clamp", "A go-to to a far target runs at 50,000 steps/s.", "firmware",
         Profiles::kFirmware, "parol6.goto.clamp-of-table"),
    from(kHomed, Hazard::kMove, "Each joint runs at 50,000 toward a far target, both ways.",
         [](BoardBench& board) {
           expect_far(board, {50'000, 50'000, 50'000, 50'000, 50'000, 50'000});
         }),

    must("parol6.goto.clamp-of-table",
         "A go-to to a far target runs at the joint's maximum in the GUI's table.",
         "document: maxima of the GUI", Profiles::kDocumented, "parol6.goto.clamp"),
    from(kHomed, Hazard::kMove,
         "Each joint runs at its own maximum toward a far target, both ways.",
         [](BoardBench& board) {
           Speeds most{};
           std::ranges::transform(kJoints, most.begin(),
                                  [](const Joint& joint) { return joint.max_speed.value; });
           expect_far(board, most);
         }),

    must("parol6.goto.unlimited", "A go-to drives a homed joint beyond its range without stopping.",
         "firmware: it knows no joint limits"),
    from(kHomed, Hazard::kMove, "J5 arrives at 6900 steps.",
         [](BoardBench& board) {
           board.spoil();  // a guard would not let it go there; so it is an emulated one
           auto targets = board.ask(idle()).position;
           targets[kJ5] = Steps{6900};
           board.about("a go-to of j5 to 6900");
           board.expect(board.keep_asking(go_to(targets), 3s), "position.j5", 6900);
         }),
};

}  // namespace

Chapter go_to_chapter() { return chapter("Go-to law", kGoToClauses); }

}  // namespace armjig::parol6::conformance
