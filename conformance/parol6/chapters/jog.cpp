// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

/// Jogs a joint there and back, so that cases leave the arm where it was.
void expect_jog(BoardBench& board, std::size_t joint, int speed, Duration time) {
  expect_speed(board, run(board, jog(joint, speed), time), joint, speed);
  board.keep_asking(jog(joint, -speed), time);
  board.act(idle());
}

void expect_directions(BoardBench& board, int speed) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto stretch = run(board, jog(j, speed), 40ms);
    board.keep_asking(jog(j, -speed), 40ms);
    board.act(idle());
    board.expect_true(steps(stretch, j) * speed > 0,
                      fmt::format("j{} to count {}", j + 1, speed > 0 ? "up" : "down"),
                      fmt::format("{} steps", steps(stretch, j)));
  }
}

void speed(BoardBench& board) {
  for (const int value : {150, 256, 1000, 1500}) expect_jog(board, 0, value, 500ms);
}

using Intervals = std::array<int, 3>;  // us

/// Of jogs of J6 at intervals that no pass of a loop meets alike: the share of the steps that it
/// was told which the slowest made, in percent.
double slowest_share(BoardBench& board, const Intervals& intervals) {
  double least = 100;
  for (const int interval : intervals) {
    const int speed = 1'000'000 / interval;
    const auto stretch = run(board, jog(kJ6, speed), 1s);
    board.keep_asking(jog(kJ6, -speed), 1s);
    board.act(idle());
    const std::chrono::duration<double> longest = stretch.after.received - stretch.before.asked;
    const double told = 1e6 / interval * longest.count() * (1 + kClockError);
    least = std::min(least, 100.0 * steps(stretch, kJ6) / told);
  }
  return least;
}

/// The steps of most speeds come late, and all that follow. Passes of more than 40 us, at which a
/// joint steps in each of the shorter intervals, are late for the longer ones.
void expect_late_steps_to_delay(BoardBench& board) {
  constexpr Intervals kShort{59, 61, 67};
  constexpr Intervals kLong{331, 359, 389};
  constexpr double kMostShare = 96;        // of a loop of 3 us and more
  constexpr double kShareOfLongPass = 62;  // 59 of more than 95 us
  const auto expect_late = [&board](double share) {
    board.about("the slowest of three jogs, against what it was told");
    board.expect_in_time({share, 0, kMostShare, "%"}, "late steps to delay the next ones",
                         "steps as often as told");
  };
  const auto share = slowest_share(board, kShort);
  expect_late(share);
  if (share < kShareOfLongPass) expect_late(slowest_share(board, kLong));
}

/// Steps/s of J6, there and back.
double pace(BoardBench& board, int speed) {
  const auto stretch = run(board, jog(kJ6, speed), 500ms);
  board.keep_asking(jog(kJ6, -speed), 500ms);
  board.act(idle());
  const std::chrono::duration<double> time = stretch.after.received - stretch.before.received;
  return steps(stretch, kJ6) / time.count();
}

/// Two speeds with intervals of 100 and 100.6 us, and of 250 and 250.6: whole passes of many loops.
void expect_intervals_cut(BoardBench& board) {
  constexpr double kAlike = 4;  // percent; rounded, it is 10 and more with passes of 10 us and more
  for (const auto& [whole, more] : {std::pair{10'000, 9940}, {4000, 3990}}) {
    const double less = 100 * (1 - pace(board, more) / pace(board, whole));
    board.about(fmt::format("jogs of j6 at {} and {} steps/s", whole, more));
    board.expect_in_time({less, -kAlike, kAlike, "%"}, "the same pace of both",
                         fmt::format("{:.1f} % less of the second", less));
  }
}

/// The speed that is reported, and the steps that are made.
void expect_clamped(BoardBench& board, std::size_t joint, int speed, int most) {
  board.about(fmt::format("a jog of j{} at {} steps/s", joint + 1, speed));
  const auto stretch = run(board, jog(joint, speed), 20ms);
  board.keep_asking(jog(joint, -speed), 20ms);
  board.act(idle());
  board.expect(stretch.after, speed_field(joint), most);
  expect_speed(board, stretch, joint, most);
}

constexpr Clause kJogClauses[] = {
    must("parol6.jog.own-joint",
         "In a jog the speed field of a joint drives that joint and no other.",
         "document, packet table; firmware"),
    from(kEnabled, Hazard::kMove, "Six jogs move six joints.",
         [](BoardBench& board) {
           for (std::size_t j = 0; j < kJointCount; ++j) {
             board.about(fmt::format("a jog of j{}", j + 1));
             const auto stretch = run(board, jog(j, 1000), 60ms);
             board.keep_asking(jog(j, -1000), 60ms);
             board.act(idle());
             expect_speed(board, stretch, j, 1000);
             for (std::size_t other = 0; other < kJointCount; ++other) {
               if (other != j)
                 board.expect_same(stretch.after, position_field(other), stretch.before);
             }
           }
         }),

    must("parol6.jog.all-together", "In a jog all joints run at once, each at its own speed.",
         "firmware"),
    from(kEnabled, Hazard::kMove, "Six joints jog at six speeds in one frame.",
         [](BoardBench& board) {
           constexpr Speeds kSpeeds{300, -400, 500, -600, 700, -800};
           constexpr Speeds kBack{-300, 400, -500, 600, -700, 800};
           const auto stretch = run(board, jog(kSpeeds), 200ms);
           board.keep_asking(jog(kBack), 200ms);
           board.act(idle());
           for (std::size_t j = 0; j < kJointCount; ++j)
             expect_speed(board, stretch, j, kSpeeds[j]);
         }),

    must("parol6.jog.forward", "A positive jog speed counts the position up.", "firmware"),
    from(kEnabled, Hazard::kMove, "Each joint counts up at a positive speed.",
         [](BoardBench& board) { expect_directions(board, 800); }),

    must("parol6.jog.backward", "A negative jog speed counts the position down.", "firmware"),
    from(kEnabled, Hazard::kMove, "Each joint counts down at a negative speed.",
         [](BoardBench& board) { expect_directions(board, -800); }),

    must(
        "parol6.jog.speed",
        "A joint jogs at the commanded steps/s, its interval cut to whole microseconds and rounded "
        "up to whole passes of the loop.",
        "firmware; arithmetic"),
    from(kEnabled, Hazard::kMove, "J1 makes the steps of four speeds.", on<speed>),
    variant("late", full(from(kHomed, Hazard::kMove, "A step that comes late delays the next one.",
                              on<expect_late_steps_to_delay>))),

    variant("cut", full(from(kHomed, Hazard::kMove,
                             "Intervals that are the same in whole microseconds are the same.",
                             on<expect_intervals_cut>))),

    must("parol6.jog.slow", "Speeds down to a few steps/s are kept too.",
         "firmware: intervals have 32 bits"),
    full(from(kEnabled, Hazard::kMove, "J6 makes the steps of 3, 7 and 20 steps/s.",
              [](BoardBench& board) {
                for (const int value : {3, 7, 20}) expect_jog(board, kJ6, value, 2s);
              })),
    variant("slowest", full(from(kEnabled, Hazard::kMove, "J6 makes the steps of 1 step/s.",
                                 [](BoardBench& board) { expect_jog(board, kJ6, 1, 3500ms); }))),

    must("parol6.jog.fast",
         "A joint jogs as fast as the GUI's tables have it, to within the length of a pass.",
         "firmware; GUI, table of jog speeds"),
    from(kEnabled, Hazard::kMove, "Each joint makes the steps of its highest jog speed.",
         [](BoardBench& board) {
           for (std::size_t j = 0; j < kJointCount; ++j)
             expect_jog(board, j, kJoints[j].max_jog.value, 100ms);
         }),

    must("parol6.jog.no-ramp", "A jog has its full speed from the first step on, without a ramp.",
         "firmware"),
    from(kEnabled, Hazard::kMove, "J6 has made 30 steps 10 ms after rest.",
         [](BoardBench& board) {
           const auto before = board.act(idle());
           board.act(jog(kJ6, 10'000));
           board.pause(8ms);
           const auto after = board.ask(jog(kJ6, 10'000));
           board.keep_asking(jog(kJ6, -10'000), 10ms);
           board.act(idle());
           board.about("10 ms after rest, at 10000 steps/s");
           board.expect(after, "speed.j6", 10'000);
           board.expect_between(after, "position.j6", before.position[kJ6].value + 30, INT32_MAX);
         }),

    must("parol6.jog.first-step",
         "The first step of a jog comes at once if the last one is longer ago than its interval.",
         "firmware: intervals count from the last step"),
    from(kEnabled, Hazard::kMove, "A very slow jog makes its first step at once.",
         [](BoardBench& board) {
           board.keep_asking(idle(), 600ms);
           const auto before = board.act(jog(kJ5, 2));
           const auto after = board.ask(jog(kJ5, 2));
           board.act(idle());
           board.about(
               "600 ms after the last step, right after the first frame of a jog at 2 steps/s");
           board.expect(after, "position.j5", before.position[kJ5].value + 1);
         }),

    must("parol6.jog.zero", "A joint whose jog speed is 0 stands still.", "firmware"),
    from(kEnabled, Hazard::kMove, "A jog without speeds moves nothing.",
         [](BoardBench& board) { expect_still(board, jog({}), 200ms); }),

    must("parol6.jog.reported", "In a jog telemetry reports the commanded speeds.", "firmware"),
    from(kEnabled, Hazard::kMove, "Six speeds come back in a jog.",
         [](BoardBench& board) {
           constexpr Speeds kSpeeds{101, -102, 103, -104, 105, -106};
           const auto answer = run(board, jog(kSpeeds), 20ms).after;
           board.keep_asking(jog({-101, 102, -103, 104, -105, 106}), 20ms);
           board.act(idle());
           expect_reported(board, answer, kSpeeds);
         }),

    must("parol6.jog.change", "Another speed during a jog takes effect with its frame.",
         "firmware"),
    from(kEnabled, Hazard::kMove, "A jog changes its speed three times.",
         [](BoardBench& board) {
           for (const int value : {200, 900, 300, 1500}) {
             board.about(fmt::format("a jog that has changed to {} steps/s", value));
             expect_speed(board, run(board, jog(kJ5, value), 100ms), kJ5, value);
           }
           board.keep_asking(jog(kJ5, -1500), 200ms);
           board.act(idle());
         }),

    must("parol6.jog.reverse", "The opposite speed during a jog turns the joint round at once.",
         "firmware"),
    from(kEnabled, Hazard::kMove, "A jog turns round six times.",
         [](BoardBench& board) {
           for (int i = 0; i < 3; ++i) {
             for (const int value : {1200, -1200}) {
               board.about(fmt::format("a jog that has turned to {} steps/s", value));
               expect_speed(board, run(board, jog(kJ5, value), 50ms), kJ5, value);
             }
           }
           board.act(idle());
         }),

    must("parol6.jog.ignores-positions", "The position fields of a jog change nothing.",
         "firmware: only go-to uses them"),
    from(kEnabled, Hazard::kMove, "A jog with extreme positions is a jog.",
         [](BoardBench& board) {
           auto frame = jog(kJ5, 400);
           frame.position = {Steps{1},          Steps{-2}, Steps{8'388'607},
                             Steps{-8'388'608}, Steps{5},  Steps{6}};
           const auto stretch = run(board, frame, 100ms);
           board.keep_asking(jog(kJ5, -400), 100ms);
           board.act(idle());
           expect_speed(board, stretch, kJ5, 400);
           board.expect_same(stretch.after, "position.j1", stretch.before);
           board.expect_same(stretch.after, "position.j3", stretch.before);
         }),

    must("parol6.jog.keeps-homed", "A jog leaves the homed bits as they are.", "firmware"),
    from(kHomed, Hazard::kMove, "A homed arm is still homed after a jog.",
         [](BoardBench& board) {
           const auto before = board.ask(idle());
           const auto stretch = run(board, jog({100, 100, 100, 100, 100, 100}), 50ms);
           board.expect_same(stretch.after, "homed", before);
           board.act(idle());
         }),

    must("parol6.jog.clamp", "A speed beyond 50,000 steps/s is reduced to it, with its sign.",
         "firmware, vector B14", Profiles::kFirmware, "parol6.jog.clamp-of-table"),
    from(kEnabled, Hazard::kMove, "Each joint jogs at 50,000 when told 60,000, both ways.",
         [](BoardBench& board) {
           for (std::size_t j = 0; j < kJointCount; ++j) {
             expect_clamped(board, j, 60'000, 50'000);
             expect_clamped(board, j, -60'000, -50'000);
           }
         }),

    must("parol6.jog.clamp-of-table",
         "A speed beyond the joint's maximum in the GUI's table is reduced to it.",
         "document: maxima of the GUI", Profiles::kDocumented, "parol6.jog.clamp"),
    from(kEnabled, Hazard::kMove, "Each joint jogs at its own maximum when told 30,000, both ways.",
         [](BoardBench& board) {
           for (std::size_t j = 0; j < kJointCount; ++j) {
             expect_clamped(board, j, 30'000, kJoints[j].max_speed.value);
             expect_clamped(board, j, -30'000, -kJoints[j].max_speed.value);
           }
         }),

    must("parol6.jog.unlimited", "A jog drives a homed joint beyond its range without stopping.",
         "firmware: it knows no joint limits"),
    from(kHomed, Hazard::kMove, "J5 goes beyond 6800 steps.",
         [](BoardBench& board) {
           board.needs_emulation();
           board.spoil();
           const auto is_outside = [](const Answer& answer) {
             return answer.position[kJ5].value > 6800;
           };
           board.about("a jog beyond 6400");
           board.expect_true(board.ask_until(jog(kJ5, 7000), is_outside, 3s).has_value(),
                             "j5 to go beyond 6800 steps", "it does not");
           board.act(idle());
         }),

    must("parol6.step.no-catch-up",
         "Steps that were not made while a joint was not run are not made up for.",
         "firmware: an interval counts from the moment of the last step"),
    from(kEnabled, Hazard::kMove, "A jog that has paused goes on where it was.",
         [](BoardBench& board) {
           board.act(jog(kJ5, 100));
           board.act(with_code(42));
           board.pause(250ms);
           const auto before = board.act(jog(kJ5, 100));
           const auto after = board.ask(jog(kJ5, 100));
           board.act(idle());
           board.about("a jog at 100 steps/s that has paused for 250 ms");
           const auto most = 2 + (after.received - before.asked) / 10ms;
           board.expect_between(after, "position.j5", before.position[kJ5].value,
                                before.position[kJ5].value + most);
         }),

    must(
        "parol6.step.same-speed-keeps-direction",
        "Setting the speed that is set already changes nothing, not even a direction that does not "
        "fit its sign.",
        "firmware", Profiles::kFirmware),
    /// J1 backs off forward while -2050 is set; a jog at -2050 does not turn it round.
    from(kEnabled, Hazard::kHome, "J1 goes on forward when a jog says -2050 while it backs off.",
         [](BoardBench& board) {
           board.spoil();
           board.touch("position.j1", -3000);
           board.touch("position.j2", -51'400);
           board.touch("position.j3", 35'000);
           board.act(with_code(kHome));
           const auto backs_off = [before = std::optional<Steps>{}](const Answer& answer) mutable {
             const auto last = std::exchange(before, answer.position[0]);
             return answer.speed[0].value == -2050 && last &&
                    answer.position[0].value > last->value;
           };
           board.about("homing that has reached the switches of J1 to J3");
           if (!board.ask_until(idle(), backs_off, 5s)) board.fail("j1 to back off", "it does not");
           const auto stretch = run(board, jog(0, -2050), 100ms);
           board.about("a jog of j1 at -2050 out of its back-off");
           expect_speed(board, stretch, 0, 2050);
         }),

    unobservable("the differences are single microseconds in an interval; recordings judge them",
                 must("parol6.step.single-precision",
                      "Ramp state is single precision, formulas double, conversions cut off toward "
                      "zero, nothing is "
                      "fused.",
                      "firmware", Profiles::kFirmware)),
};

}  // namespace

Chapter jog_chapter() { return chapter("Jog and stepping", kJogClauses); }

}  // namespace armjig::parol6::conformance
