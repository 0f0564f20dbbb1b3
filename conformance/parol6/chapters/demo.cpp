// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <span>
#include <vector>

#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

/// Counters at power-up are 0, so every leg has its way to go. The longest takes
/// 15.2 s, and more on a board with a long loop.
constexpr Duration kLeg = 40s;

/// Answers until one takes more than a second, for the board sleeps between its legs; the first leg
/// ends with that one.
struct Sleep {
  std::vector<Answer> leg;
  Answer after;  ///< the next one
  Duration length{};
};

Sleep run_out(BoardBench& board) {
  Sleep sleep;
  const auto end = board.now() + kLeg;
  while (!board.is_over() && !board.error() && board.now() < end) {
    const auto answer = sleep.leg.emplace_back(board.ask(with_code(kDemo), 3s));
    sleep.length = answer.received - answer.asked;
    if (sleep.length > 1s) {
      sleep.after = board.ask(with_code(kDemo));
      return sleep;
    }
    board.pause(kFramePeriod);
  }
  board.fail("a sleep at the end of the first leg", "none within 40 s");
  return {};
}

/// Of counts that are alike modulo 65536 the one next to what was reckoned.
double unwrapped(int timing, double reckoned) {
  constexpr double kTurn = 65'536;
  return timing + kTurn * std::round((reckoned - timing) / kTurn);
}

/// How fast the board's timer runs by our clock is told by the leg before the sleep.
void expect_timer_to_run_on(BoardBench& board, std::span<const Answer> leg) {
  if (leg.size() < 3) return;
  const auto ours = [](const Answer& from, const Answer& to) {
    return ticks_in(to.received - from.received);
  };
  const auto awake = leg.first(leg.size() - 1);
  double counted = 0;
  for (std::size_t i = 1; i < awake.size(); ++i) {
    counted += unwrapped(awake[i].timing, ours(awake[i - 1], awake[i]));
  }
  const double rate = counted / ours(awake.front(), awake.back());
  const double reckoned = rate * ours(awake.back(), leg.back());
  const double slept = unwrapped(leg.back().timing, reckoned);
  const double late = ticks_in(15ms);
  board.about("the timing of the answer after the sleep, modulo 65536");
  board.expect_in_time({slept, reckoned - late, reckoned + late, "ticks"},
                       fmt::format("about {:.0f} ticks", reckoned),
                       fmt::format("timing {}", leg.back().timing));
}

Answer run_back(BoardBench& board) {
  const auto is_back = [](const Answer& answer) { return answer.position == kStandby; };
  const auto answer = board.ask_until(with_code(kDemo), is_back, kLeg);
  if (!answer) board.fail("all joints at their standby positions", "not within 40 s");
  return answer.value_or(Answer{});
}

/// Where neither the first steps of a leg nor its last ones are judged, nor the length of a step.
constexpr int kSomeSteps = 200;

/// The answers of a leg with which a joint is on its way.
std::vector<Answer> on_the_way(std::span<const Answer> leg, std::size_t joint, int from, int to) {
  const auto sign = to < from ? -1 : 1;
  std::vector<Answer> answers;
  std::ranges::copy_if(leg, std::back_inserter(answers), [&](const Answer& answer) {
    const auto at = answer.position[joint].value;
    return (at - from) * sign > kSomeSteps && (to - at) * sign > kSomeSteps;
  });
  return answers;
}

/// Each joint gets faster, keeps its maximum if there is way enough, and gets slower. None goes the
/// other way at first, or much beyond its end.
void expect_leg(BoardBench& board, std::span<const Answer> leg, const Speeds& from,
                const Speeds& to) {
  constexpr double kTolerance = 0.03;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    board.about(fmt::format("j{} from {} to {} in the demonstration", j + 1, from[j], to[j]));
    constexpr int kBeyond = 2;  // the last step of a ramp may be one too many, and is taken back
    const auto furthest = from[j] == to[j] ? to[j] : to[j] + (to[j] < from[j] ? -kBeyond : kBeyond);
    const auto [lowest, highest] = std::minmax({from[j], furthest});
    for (const auto& answer : leg) board.expect_between(answer, position_field(j), lowest, highest);
    if (from[j] == to[j]) continue;
    const double most = kDemoSpeeds[j];
    const auto answers = on_the_way(leg, j, from[j], to[j]);
    board.expect_true(answers.size() > 10, "a ramp for a while",
                      fmt::format("{} answers show it", answers.size()));
    for (const auto& answer : answers) {
      const auto at = answer.position[j].value;
      const auto nearest_end = std::min(std::abs(at - from[j]), std::abs(to[j] - at));
      const auto wanted = std::min(most, ramp_speed(most, nearest_end));
      const auto speed = answer.speed[j].value * (to[j] < from[j] ? -1 : 1);
      board.expect_true(std::abs(speed - wanted) <= kTolerance * wanted + 20,
                        fmt::format("a speed of {:.0f} steps/s at {}", wanted, at),
                        fmt::format("{} steps/s", speed));
    }
    expect_pace(board, answers, j);
  }
}

constexpr Speeds standby() {
  Speeds places{};
  std::ranges::transform(kStandby, places.begin(), &Steps::value);
  return places;
}

/// The whole demonstration, from where the joints stand.
void expect_both_legs(BoardBench& board, const Speeds& from) {
  std::vector<Answer> log;
  std::size_t turn = 0;
  const auto end = board.now() + 2 * kLeg;
  do {
    log.push_back(board.ask(with_code(kDemo), 3s));
    if (log.back().received - log.back().asked > 1s) turn = log.size();
    board.pause(kFramePeriod);
  } while ((turn == 0 || log.back().position != kStandby) && !board.is_over() && !board.error() &&
           board.now() < end);
  const std::span<const Answer> legs{log};
  expect_seen(board, legs, "the demonstration");
  expect_leg(board, legs.first(turn), from, kDemoOut);
  expect_leg(board, legs.subspan(turn), kDemoOut, standby());
}

/// How a homed arm sets out, and that it stands when it is told so.
void expect_setting_out(BoardBench& board) {
  board.spoil_memory();
  std::vector<Answer> log;
  for (const auto end = board.now() + 3s; board.now() < end && !board.is_over() && !board.error();
       board.pause(kFramePeriod)) {
    log.push_back(board.ask(with_code(kDemo)));
  }
  board.act(idle());
  board.about("idle in the demonstration");
  expect_still(board, idle(), 100ms);
  expect_seen(board, log, "the demonstration");
  expect_leg(board, log, standby(), kDemoOut);
  board.walk_to_standby();
}

/// Code 69 meets a joint whose way in the demonstration is the other one: it brakes first, with the
/// acceleration of the demonstration, and then turns.
template <class Condition>
void expect_turn(BoardBench& board, std::size_t joint, Condition is_on_its_way) {
  board.needs_emulation();
  board.spoil();
  board.act(with_code(kHome));
  board.about(fmt::format("the final move of j{}", joint + 1));
  if (!board.ask_until(idle(), is_on_its_way, 60s)) {
    return board.fail("the joint to be fast on it", "it is not");
  }
  board.act(with_code(kDemo));
  const auto first = board.ask(with_code(kDemo));
  const double speed = first.speed[joint].value;
  const int sign = speed < 0 ? -1 : 1;
  const auto gone = [&](const Answer& answer) {
    return (answer.position[joint].value - first.position[joint].value) * sign;
  };
  int furthest = 0;
  const auto has_turned = [&](const Answer& answer) {
    furthest = std::max(furthest, gone(answer));
    return gone(answer) < 0;
  };
  board.about(fmt::format("j{} in a demonstration that has ended its homing", joint + 1));
  const bool turns = board.ask_until(with_code(kDemo), has_turned, 8s).has_value();
  const double wanted = speed * speed / (2.0 * kDemoSpeeds[joint]);
  board.expect_true(turns && std::abs(furthest - wanted) < 0.05 * wanted + 30,
                    fmt::format("it to turn after {:.0f} steps", wanted),
                    turns ? fmt::format("it turns after {}", furthest) : "it does not turn");
}

/// A joint that has begun to brake for its end is led back, and a little towards it again: there it
/// gets faster again, from the speed to which it had braked.
void expect_to_go_on_after_braking(BoardBench& board, std::size_t joint) {
  board.spoil_memory();
  const auto end = kDemoOut[joint];
  const int sign = end < kStandby[joint].value ? -1 : 1;
  const auto left = [=](const Answer& answer) {
    return (end - answer.position[joint].value) * sign;
  };
  const int some_way = kDemoSpeeds[joint] / 4;  // half of that on which it brakes
  board.about(fmt::format("j{} at the end of its way out", joint + 1));
  const auto braking = board.ask_until(
      with_code(kDemo), [&](const Answer& answer) { return left(answer) < some_way; }, kLeg);
  if (!braking) return board.fail("the joint to get there", "it does not");
  const auto is_far = [&](const Answer& answer) { return left(answer) > 6 * some_way; };
  board.about(fmt::format("a jog of j{} in a demonstration", joint + 1));
  if (!board.ask_until(jog(joint, -2000 * sign), is_far, 20s)) {
    return board.fail("the joint to go back", "it does not");
  }
  board.keep_asking(jog(joint, 500 * sign), 100ms);
  const auto after = board.keep_asking(with_code(kDemo), 100ms);
  const auto slowest = braking->speed[joint].value * sign;
  board.about(fmt::format("j{}, which goes on after it had begun to brake", joint + 1));
  board.expect_true(after.speed[joint].value * sign >= slowest,
                    fmt::format("a speed of {} steps/s and more", slowest),
                    fmt::format("{} steps/s", after.speed[joint].value * sign));
  board.act(idle());
  board.walk_to_standby();
}

/// The final move of J1 is ended by a slow jog. The ramp begins at the step that belongs to its
/// speed, with the interval of before: so it ends soon.
void expect_short_ramp_after_jog(BoardBench& board) {
  board.needs_emulation();
  board.spoil();
  board.act(with_code(kHome));
  board.about("the final move of j1");
  const auto is_on_its_way = [](const Answer& answer) {
    return answer.position[kJ1].value > 600 && answer.speed[kJ1].value > 2200;
  };
  if (!board.ask_until(idle(), is_on_its_way, 30s)) {
    return board.fail("j1 to get faster on it", "it does not");
  }
  board.keep_asking(jog(kJ1, 200), 50ms);
  const auto after = board.keep_asking(with_code(kDemo), 100ms);
  board.about("j1 in a demonstration, 100 ms after a jog that has ended its homing");
  board.expect(after, speed_field(kJ1), kDemoSpeeds[kJ1]);
}

constexpr Clause kDemoClauses[] = {
    must("parol6.demo",
         "Code 69 drives all joints out to 6179, -22222, 49812, 0, 4059, 46075 and back to their "
         "standby positions.",
         "firmware", Profiles::kFirmware, "parol6.demo.unknown"),
    full(from(kHomed, Hazard::kMove, "All joints go out and come back.",
              [](BoardBench& board) {
                board.spoil_memory();
                const auto out = run_out(board).after;
                board.about("the first answers after the sleep");
                for (std::size_t j = 0; j < kJointCount; ++j) {
                  board.expect_between(out, position_field(j), kDemoOut[j] - 40, kDemoOut[j] + 40);
                }
                run_back(board);
              })),
    variant("sets-out", from(kHomed, Hazard::kMove, "Joints set out from where homing ends.",
                             [](BoardBench& board) { expect_setting_out(board); })),

    must("parol6.demo.unknown", "Code 69 has no meaning and moves nothing.",
         "document: not among its codes", Profiles::kDocumented, "parol6.demo"),
    from(kHomed, Hazard::kMove, "No joint moves with code 69.",
         [](BoardBench& board) {
           board.spoil_memory();
           board.about("code 69");
           expect_still(board, with_code(kDemo), 500ms);
         }),

    must("parol6.demo.disabled", "The demonstration also runs while disabled.",
         "firmware: not guarded by the flag", Profiles::kFirmware),
    full(from(kHomed, Hazard::kMove, "Joints move with code 69 after disable.",
              [](BoardBench& board) {
                board.spoil_memory();
                board.act(with_code(kDisable));
                board.about("code 69 while disabled");
                expect_moved(board, run(board, with_code(kDemo), 500ms));
                board.act(with_code(kEnable));
                board.walk_to_standby();
              })),

    must("parol6.demo.sleeps",
         "Between its two legs the board sleeps for 2 s, and answers afterwards what came "
         "meanwhile; its timer runs on.",
         "firmware", Profiles::kFirmware),
    full(from(kHomed, Hazard::kMove, "One answer between the legs takes 2 s.",
              [](BoardBench& board) {
                board.spoil_memory();
                const auto sleep = run_out(board);
                board.expect_in_time({milliseconds(sleep.length), 1900, 2100, "ms"},
                                     "one answer after 2 s",
                                     fmt::format("it took {} ms", sleep.length / 1ms));
                expect_timer_to_run_on(board, sleep.leg);
                run_back(board);
              })),

    must("parol6.demo.ramp",
         "The demonstration drives J1 with at most 6000 steps/s and 6000 steps/s^2.",
         "firmware, vector S8", Profiles::kFirmware),
    from(kFresh, Hazard::kMove, "J1 has the speeds of its ramp at 1000 and at 3050 steps.",
         [](BoardBench& board) {
           board.spoil();
           const auto has_sped_up = [](const Answer& answer) {
             return answer.position[0].value > 1000;
           };
           const auto answer = board.ask_until(with_code(kDemo), has_sped_up, 5s);
           board.about("j1 some 1000 steps into the demonstration");
           if (!answer) return board.fail("j1 to go up", "it does not");
           board.expect_between(*answer, "speed.j1", 3400, 3800);
           const auto is_fast = [](const Answer& later) { return later.position[0].value > 3050; };
           const auto fast = board.ask_until(with_code(kDemo), is_fast, 5s);
           board.about("j1 half-way in the demonstration");
           if (fast) board.expect_between(*fast, "speed.j1", 5850, 6000);
         }),

    must("parol6.demo.ramps",
         "On both legs of the demonstration all joints accelerate with, and go at most at, 6000, "
         "4000, 3500, 3500, 3500 and 7500.",
         "firmware, vector S8", Profiles::kFirmware),
    full(from(kFresh, Hazard::kMove, "Five joints keep to their ramps, out and back.",
              [](BoardBench& board) {
                board.spoil();
                expect_both_legs(board, {});
              })),
    variant("homed", full(from(kHomed, Hazard::kMove, "And so they do from where homing ends.",
                               [](BoardBench& board) {
                                 board.spoil_memory();
                                 expect_both_legs(board, standby());
                               }))),

    must("parol6.demo.takes-over",
         "Joints that homing leads to their final positions go on from there with the maxima and "
         "accelerations of the demonstration.",
         "firmware: 69 goes on with whatever the steppers have", Profiles::kFirmware),
    full(from(kFresh, Hazard::kMove, "J1 gets faster with 6000 steps/s^2 after 4500.",
              [](BoardBench& board) {
                board.needs_emulation();
                board.spoil();
                board.act(with_code(kHome));
                const auto is_on_its_way = [](const Answer& answer) {
                  return answer.position[kJ1].value > 600 && answer.speed[kJ1].value > 2200;
                };
                board.about("the final move of j1");
                if (!board.ask_until(idle(), is_on_its_way, 30s)) {
                  return board.fail("j1 to get faster on it", "it does not");
                }
                board.act(with_code(kDemo));
                const auto first = board.ask(with_code(kDemo));
                const auto is_far = [](const Answer& answer) {
                  return answer.position[kJ1].value > 2400;
                };
                const auto later = board.ask_until(with_code(kDemo), is_far, 3s);
                board.about("j1 in a demonstration that has ended its homing");
                if (!later) return board.fail("j1 to go on", "it does not");
                const auto way = later->position[kJ1].value - first.position[kJ1].value;
                const auto wanted =
                    std::hypot(first.speed[kJ1].value, ramp_speed(kDemoSpeeds[kJ1], way));
                board.expect_true(std::abs(later->speed[kJ1].value - wanted) < 0.03 * wanted,
                                  fmt::format("a speed of {:.0f} steps/s", wanted),
                                  fmt::format("{} steps/s", later->speed[kJ1].value));
              })),

    variant("turns-down", full(from(kFresh, Hazard::kMove, "J2, on its way up, brakes and turns.",
                                    [](BoardBench& board) {
                                      expect_turn(board, kJ2, [](const Answer& answer) {
                                        return answer.position[kJ2].value > 1200 &&
                                               answer.speed[kJ2].value > 2600;
                                      });
                                    }))),
    variant("turns-up", full(from(kFresh, Hazard::kMove, "J6, on its way down, brakes and turns.",
                                  [](BoardBench& board) {
                                    expect_turn(board, kJ6, [](const Answer& answer) {
                                      return answer.position[kJ5].value > 1600 &&
                                             answer.position[kJ6].value < 14'000 &&
                                             answer.speed[kJ6].value < -3000;
                                    });
                                  }))),

    variant("after-jog",
            full(from(kFresh, Hazard::kMove, "J1 is at its maximum soon after a slow jog.",
                      on<expect_short_ramp_after_jog>))),

    must("parol6.demo.once",
         "A demonstration that has ended does not begin again until an idle frame has reset it.",
         "firmware", Profiles::kFirmware),
    full(from(kHomed, Hazard::kMove, "The demonstration runs again only after an idle frame.",
              [](BoardBench& board) {
                board.spoil_memory();
                run_out(board);
                run_back(board);
                board.about("code 69 after the end of a demonstration");
                expect_still(board, with_code(kDemo), 500ms);
                board.keep_asking(jog(0, 500), 300ms);
                board.about("code 69 after the end of a demonstration and a jog");
                expect_still(board, with_code(kDemo), 500ms);
                board.act(idle());
                board.about("code 69 after the end of a demonstration and idle");
                expect_moved(board, run(board, with_code(kDemo), 500ms));
                board.walk_to_standby();
              })),

    must("parol6.demo.interrupted",
         "Another code than idle pauses the demonstration, and 69 goes on with it.", "firmware",
         Profiles::kFirmware),
    full(from(kHomed, Hazard::kMove, "The demonstration stands while code 42 is sent, and goes on.",
              [](BoardBench& board) {
                board.spoil_memory();
                board.keep_asking(with_code(kDemo), 1s);
                board.act(with_code(42));
                board.about("code 42 in a demonstration");
                expect_still(board, with_code(42), 200ms);
                const auto before = board.ask(with_code(kDemo));
                const auto after = board.keep_asking(with_code(kDemo), 200ms);
                board.about("code 69 again");
                board.expect_between(after, "position.j3", INT32_MIN,
                                     before.position[kJ3].value - 100);
                board.walk_to_standby();
              })),

    variant("braking-up",
            full(from(kHomed, Hazard::kMove, "J6, led back from the end, gets faster again.",
                      [](BoardBench& board) { expect_to_go_on_after_braking(board, kJ6); }))),
    variant("braking-down",
            full(from(kHomed, Hazard::kMove, "J3, led back from the end, gets faster again.",
                      [](BoardBench& board) { expect_to_go_on_after_braking(board, kJ3); }))),

    must("parol6.demo.stopped-joints",
         "Joints that a jog of speed 0 has stopped in the demonstration stay where they are, and "
         "their leg does not end.",
         "firmware: 69 goes on with whatever the steppers have", Profiles::kFirmware),
    full(from(kHomed, Hazard::kMove, "No joint moves with code 69 after a jog without speeds.",
              [](BoardBench& board) {
                board.spoil_memory();
                board.keep_asking(with_code(kDemo), 500ms);
                board.act(jog({}));
                board.about("code 69 after a jog without speeds in a demonstration");
                expect_still(board, with_code(kDemo), 500ms);
                board.walk_to_standby();
              })),

    must("parol6.demo.lowers-maximum",
         "The maximum speeds of the demonstration, 6000, 4000, 3500, 3500, 3500, 7500, stay in "
         "force "
         "until power-off.",
         "firmware", Profiles::kFirmware),
    from(kFresh, Hazard::kMove, "Six jogs are clamped to six lower speeds.",
         [](BoardBench& board) {
           board.spoil();
           board.keep_asking(with_code(kDemo), 100ms);
           board.act(idle());
           constexpr int kFast = 60'000;
           board.act(jog({kFast, -kFast, kFast, -kFast, kFast, -kFast}));
           board.about("a jog at 60,000 after a demonstration");
           expect_reported(board, board.ask(jog({kFast, -kFast, kFast, -kFast, kFast, -kFast})),
                           {kDemoSpeeds[kJ1], -kDemoSpeeds[kJ2], kDemoSpeeds[kJ3],
                            -kDemoSpeeds[kJ4], kDemoSpeeds[kJ5], -kDemoSpeeds[kJ6]});
         }),

    must("parol6.demo.pauses-homing", "Code 69 pauses homing and runs the demonstration.",
         "firmware", Profiles::kFirmware),
    from(kFresh, Hazard::kMove, "J1 goes up with code 69 while it homes downward.",
         [](BoardBench& board) {
           board.spoil();
           board.act(with_code(kHome));
           board.keep_asking(idle(), 100ms);
           const auto stretch = run(board, with_code(kDemo), 500ms);
           board.about("j1, which homes downward, in 500 ms of code 69");
           board.expect_true(steps(stretch, 0) > 100, "more than 100 steps up",
                             fmt::format("{} steps", steps(stretch, 0)));
           board.about("a jog after it");
           expect_moved(board, run(board, jog(4, 1000), 50ms));
         }),

    must("parol6.demo.disabled-interrupted",
         "A demonstration of a disabled board stands still while another code comes.", "firmware",
         Profiles::kFirmware),
    from(kFresh, Hazard::kMove, "Six codes in turn stop the demonstration of a disabled board.",
         [](BoardBench& board) {
           spoil_disabled(board);
           for (const int code : {42, 100, 102, 103, 123, 156}) {
             board.keep_asking(with_code(kDemo), 300ms);
             board.act(with_code(code));
             board.about(fmt::format("code {} in a demonstration while disabled", code));
             expect_still(board, with_code(code), 100ms);
           }
         }),
};

}  // namespace

Chapter demo_chapter() { return chapter("Demonstration", kDemoClauses); }

}  // namespace armjig::parol6::conformance
