// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr std::array kBaseJoints{kJ1, kJ2, kJ3};

HomingRecord record(BoardBench& board) {
  const auto& log = board.homing_log();
  expect_seen(board, log, "the run of homing");
  return HomingRecord{log};
}

/// While these were homed, these joints stood where they stood at first.
void expect_unmoved(BoardBench& board, const HomingRecord& run, std::uint8_t homed,
                    std::initializer_list<std::size_t> joints, std::string_view when) {
  for (const auto& answer : run.with_bits(homed)) {
    for (const auto joint : joints) {
      board.about(std::string{when});
      board.expect_same(answer, position_field(joint), run.first());
    }
  }
}

std::int32_t position(const Answer& answer, std::size_t joint) {
  return answer.position[joint].value;
}

/// The highest (or lowest) position while the joint backs off: the target, or as little short of it
/// as it went between two answers.
void expect_back_off(BoardBench& board, std::uint8_t homed, std::size_t joint) {
  const auto speed = kHoming[joint].back_off;
  const auto target = kHoming[joint].back_off_to;
  const auto backing_off = record(board).with_speed(homed, joint, speed);
  board.about("the back-off from the switch");
  if (backing_off.size() < 2) {
    board.fail(fmt::format("j{} to back off at {} steps/s", joint + 1, speed), "it does not");
    return;
  }
  const auto sign = target < 0 ? -1 : 1;
  Duration longest{};
  auto furthest = 0;
  for (std::size_t i = 0; i < backing_off.size(); ++i) {
    furthest = std::max(furthest, position(backing_off[i], joint) * sign);
    if (i > 0) longest = std::max(longest, backing_off[i].received - backing_off[i - 1].asked);
  }
  const auto missed =
      std::chrono::duration<double>(longest + board.noise() + kFramePeriod).count() *
      std::abs(speed);
  board.expect_true(furthest <= target * sign && furthest >= target * sign - missed,
                    fmt::format("j{} to go to {}, seen from {:.0f} on", joint + 1, target,
                                target - sign * missed),
                    fmt::format("it goes to {}", furthest * sign));
}

void expect_rest(BoardBench& board, std::uint8_t homed, std::size_t joint) {
  const auto answers = record(board).with_bits(homed);
  board.about(fmt::format("while homed is {:02X}", homed));
  if (answers.empty()) return board.fail("such answers", "none");
  for (const auto& answer : answers)
    board.expect(answer, position_field(joint), kHoming[joint].end);
}

/// Of a final move.
enum class Part : std::uint8_t { kBegin, kEnd };

/// Steps from the beginning, or to the end.
std::int32_t way_on_ramp(const Answer& answer, std::size_t joint, int from, int to, Part part) {
  const auto at = position(answer, joint);
  return (part == Part::kBegin ? at - from : to - at) * (to > from ? 1 : -1);
}

/// Answers from the first third of a final move, or from its last, where the maximum does not
/// matter; the first steps are left out.
std::vector<Answer> on_ramp(BoardBench& board, std::uint8_t homed, std::size_t joint, int from,
                            int to, Part part) {
  const auto sign = to > from ? 1 : -1;
  std::vector<Answer> answers;
  for (const auto& answer : record(board).with_bits(homed)) {
    const auto way = way_on_ramp(answer, joint, from, to, part);
    const auto speed = answer.speed[joint].value * sign;
    const bool is_on_ramp = way > 200 && way < std::abs(to - from) / 3 && speed > 0;
    // What homing sets before and after a ramp has the same positions, but not such speeds.
    const bool is_set = speed == 2050 || speed == 4050 || speed == 5550 || speed == 1050;
    if (is_on_ramp && !is_set) answers.push_back(answer);
  }
  return answers;
}

void expect_ramp(BoardBench& board, std::uint8_t homed, std::size_t joint, int from, int to,
                 double acceleration, Part part = Part::kBegin) {
  constexpr double kTolerance = 0.03;
  const auto sign = to > from ? 1 : -1;
  const auto answers = on_ramp(board, homed, joint, from, to, part);
  for (const auto& answer : answers) {
    const auto way = way_on_ramp(answer, joint, from, to, part);
    const auto speed = answer.speed[joint].value * sign;
    const auto wanted = ramp_speed(acceleration, way);
    board.about(fmt::format("j{} {} steps {} its final move", joint + 1, way,
                            part == Part::kBegin ? "into" : "before the end of"));
    board.expect_true(std::abs(speed - wanted) <= kTolerance * wanted + 20,
                      fmt::format("a speed of {:.0f} steps/s", wanted),
                      fmt::format("{} steps/s", speed));
  }
  board.expect_true(answers.size() >= 3,
                    fmt::format("j{} to make a final move on a ramp", joint + 1),
                    fmt::format("{} answers show it", answers.size()));
}

void expect_final_ramp(BoardBench& board, std::uint8_t homed, std::size_t joint,
                       Part part = Part::kBegin) {
  expect_ramp(board, homed, joint, 0, kHoming[joint].end, kHoming[joint].acceleration, part);
}

/// On the first and the last third of a final move.
void expect_ramp_pace(BoardBench& board, std::uint8_t homed, std::size_t joint, int from, int to) {
  for (const auto part : {Part::kBegin, Part::kEnd}) {
    board.about(part == Part::kBegin ? "a final move that gets faster"
                                     : "a final move that gets slower");
    expect_pace(board, on_ramp(board, homed, joint, from, to, part), joint);
  }
}

/// While `leader` backs off, and the joint has not got there yet. Only the magnitude of the speed
/// that is set matters.
void expect_back_off_pace(BoardBench& board, std::uint8_t homed, std::size_t joint,
                          std::size_t leader) {
  const auto target = kHoming[joint].back_off_to;
  auto answers = record(board).with_speed(homed, leader, kHoming[leader].back_off);
  std::erase_if(answers, [&](const Answer& answer) { return position(answer, joint) == target; });
  board.about("the back-off from the switch");
  if (answers.size() < 3) {
    return board.fail(fmt::format("j{} to back off for a while", joint + 1), "it does not");
  }
  const auto speed = std::abs(kHoming[joint].back_off);
  expect_speed(board, {answers.front(), answers.back()}, joint, target < 0 ? -speed : speed);
}

/// The first seek is that short or longer as the arm stood; the other two have their length.
void expect_speeds(BoardBench& board, std::uint8_t homed, std::size_t joint) {
  const auto seek = kHoming[joint].seek;
  const auto back_off = kHoming[joint].back_off;
  const auto slow = kHoming[joint].slow_seek;
  const auto run = record(board);
  for (const auto speed : {back_off, slow}) {
    board.about("back-off and second seek");
    board.expect_true(run.with_speed(homed, joint, speed).size() > 2,
                      fmt::format("speed.j{} = {} for a while", joint + 1, speed), "never");
  }
  const auto slowly = run.with_speed(homed, joint, slow);
  board.about("the second seek");
  if (!slowly.empty()) expect_speed(board, {slowly.front(), slowly.back()}, joint, slow);
  auto seeking = run.with_speed(homed, joint, seek);
  while (seeking.size() > 1 && position(seeking[0], joint) == position(seeking[1], joint)) {
    seeking.erase(seeking.begin());  // it waits for its turn with the speed set
  }
  board.about("the first seek");
  if (seeking.empty()) return board.leave_open("it stood at its switch already");
  expect_speed(board, {seeking.front(), seeking.back()}, joint, seek);
}

constexpr Clause kHomeRunClauses[] = {
    must("parol6.home.once", "One home command, followed by idle frames, homes the whole arm.",
         "document, home; firmware: 255 goes on with homing"),
    from(kHomed, Hazard::kObserve, "One home command was enough.",
         [](BoardBench& board) { board.expect_bits(record(board).last(), "homed", 0xFC, 0xFC); }),
    /// From power-up, so that a board that never gets there fails this and not all that needs it.
    variant("at-all",
            full(from(kEnabled, Hazard::kHome, "A board homes within 90 s.", on<home_by_idling>))),

    variant("echo", from(kHomed, Hazard::kObserve, "The idle frames were echoed as what they are.",
                         [](BoardBench& board) {
                           for (const auto& answer : board.homing_log()) {
                             board.about("an idle frame while the arm homes");
                             board.expect(answer, "echo", static_cast<int>(kIdle));
                           }
                         })),

    must("parol6.home.order",
         "J1 to J3 home together, then J4, then J6 parks, then J5 homes while J6 returns.",
         "firmware"),
    from(kHomed, Hazard::kObserve, "No joint moved before its block's turn.",
         [](BoardBench& board) {
           const auto run = record(board);
           expect_unmoved(board, run, kNoneHomed, {kJ4}, "before J1 to J3 are homed");
           expect_unmoved(board, run, kFirstThreeHomed, {kJ6}, "before J4 is homed");
           for (const auto& answer : run.with_speed(kFirstFourHomed, kJ6, kHoming[kJ6].seek)) {
             board.about("while J6 seeks");
             board.expect_same(answer, "position.j5", run.first());
           }
         }),

    must("parol6.home.bits",
         "While the arm homes its homed bits go 03, E3, F3, FF and nothing else.",
         "firmware; recordings"),
    from(kHomed, Hazard::kObserve, "homed took four values, in order.",
         [](BoardBench& board) {
           const auto seen = record(board).bits();
           constexpr std::uint8_t kWanted[] = {kNoneHomed, kFirstThreeHomed, kFirstFourHomed,
                                               kAllHomed};
           std::string text;
           for (const auto value : seen) text += fmt::format(" {:02X}", value);
           board.expect_true(std::ranges::equal(seen, kWanted),
                             "homed = 03 E3 F3 FF, one after the other", "homed =" + text);
         }),

    must("parol6.home.bits-taken-back",
         "The first pass of a run of homing takes all homed bits back.", "firmware"),
    full(from(kHomed, Hazard::kHome, "A homed arm that homes again is not homed.",
              [](BoardBench& board) {
                board.act(with_code(kHome));
                board.about("home on a homed arm");
                board.expect(board.ask(idle()), "homed", 0x03);
                board.act(with_code(kEnable));
              })),

    must("parol6.home.seek-speeds",
         "The first pass of a run sets the seek speeds of all six joints, also of those whose turn "
         "comes later: -2050, -2550, -2550, 5550, -5050, -9550.",
         "firmware; recordings"),
    from(kHomed, Hazard::kObserve, "The first answer of the run had six seek speeds.",
         [](BoardBench& board) { expect_reported(board, record(board).first(), seek_speeds()); }),

    must("parol6.home.seek-motion",
         "J1, J2 and J3 seek their switches downward at 2050, 2550 and 2550 steps/s.", "firmware"),
    from(kHomed, Hazard::kObserve, "J1 to J3 went down as fast as they said.",
         [](BoardBench& board) {
           for (const auto joint : {kJ1, kJ2, kJ3}) {
             const auto seek = kHoming[joint].seek;
             auto seeking = record(board).with_speed(kNoneHomed, joint, seek);
             // J1 has this speed also while it backs off.
             const auto turned =
                 std::ranges::adjacent_find(seeking, [&](const auto& a, const auto& b) {
                   return position(b, joint) > position(a, joint);
                 });
             seeking.erase(turned == seeking.end() ? turned : turned + 1, seeking.end());
             if (seeking.size() < 10) continue;
             board.about("the first seek");
             expect_speed(board, {seeking.front(), seeking.back()}, joint, seek);
           }
         }),

    must("parol6.home.ramps-brake",
         "The final moves of J1 to J5 brake with the accelerations with which they begin.",
         "firmware, vectors S1 to S6"),
    from(kHomed, Hazard::kObserve, "J1 to J5 braked as they should.",
         [](BoardBench& board) {
           for (const auto joint : {kJ1, kJ2, kJ3}) {
             expect_final_ramp(board, kNoneHomed, joint, Part::kEnd);
           }
           expect_final_ramp(board, kFirstThreeHomed, kJ4, Part::kEnd);
           expect_final_ramp(board, kFirstFourHomed, kJ5, Part::kEnd);
         }),

    must("parol6.home.ramp-pace",
         "On a final move a joint makes the steps of the speed that it reports, which changes with "
         "each of them.",
         "firmware, vectors S1 to S7; arithmetic"),
    from(kHomed, Hazard::kObserve, "All joints were as fast as they said at the ends of moves.",
         [](BoardBench& board) {
           const auto expect_final = [&](std::uint8_t homed, std::size_t joint) {
             expect_ramp_pace(board, homed, joint, 0, kHoming[joint].end);
           };
           for (const auto joint : {kJ1, kJ2, kJ3}) expect_final(kNoneHomed, joint);
           expect_final(kFirstThreeHomed, kJ4);
           expect_final(kFirstFourHomed, kJ5);
           expect_ramp_pace(board, kFirstFourHomed, kJ6, 0, kParkingJ6);
         }),

    must("parol6.home.back-off-pace",
         "Joints back off as fast as the speeds say that are set: J1 to J3 at 2050 steps/s, J4 to "
         "J6 at 4050.",
         "firmware; arithmetic"),
    from(kHomed, Hazard::kObserve, "All joints backed off as fast as they should.",
         [](BoardBench& board) {
           for (const auto joint : {kJ1, kJ2, kJ3}) {
             expect_back_off_pace(board, kNoneHomed, joint, kJ2);
           }
           expect_back_off_pace(board, kFirstThreeHomed, kJ4, kJ4);
           for (const auto joint : {kJ5, kJ6}) {
             expect_back_off_pace(board, kFirstFourHomed, joint, joint);
           }
         }),

    must("parol6.home.waiting-speeds",
         "A joint that waits for its turn reports its seek speed until then: J4 while J1 to J3 "
         "home, "
         "J5 and J6 until J4 is homed.",
         "firmware; recordings"),
    from(kHomed, Hazard::kObserve, "J4, J5 and J6 said their seek speeds while they waited.",
         [](BoardBench& board) {
           const auto run = record(board);
           const auto expect_waiting = [&](std::uint8_t homed, std::size_t joint) {
             board.about(fmt::format("while homed is {:02X}", homed));
             for (const auto& answer : run.with_bits(homed)) {
               board.expect(answer, speed_field(joint), kHoming[joint].seek);
             }
           };
           for (const auto joint : {kJ4, kJ5, kJ6}) expect_waiting(kNoneHomed, joint);
           for (const auto joint : {kJ5, kJ6}) expect_waiting(kFirstThreeHomed, joint);
         }),

    must("parol6.home.speeds-at-rest",
         "While the others home, J4 at rest reports a speed of 2050, and J6 when parked 1050.",
         "firmware; recordings"),
    from(kHomed, Hazard::kObserve, "J4 said 2050 when homed, J6 1050 while J5 backed off.",
         [](BoardBench& board) {
           const auto run = record(board);
           for (const auto& answer : run.with_bits(kFirstFourHomed)) {
             board.about("after J4 is homed");
             board.expect(answer, "speed.j4", 2050);
           }
           const auto backing_off = run.with_speed(kFirstFourHomed, kJ5, kHoming[kJ5].back_off);
           board.expect_true(!backing_off.empty(), "J5 to back off", "it does not");
           for (const auto& answer : backing_off) {
             board.about("after J6 is parked");
             board.expect(answer, "speed.j6", 1050);
           }
         }),

    must("parol6.home.waits-for-turn",
         "J4, J5 and J6 stand still until their turn in homing has come.", "firmware"),
    from(kHomed, Hazard::kObserve, "J4 to J6 stood still at first, J5 and J6 for longer.",
         [](BoardBench& board) {
           const auto run = record(board);
           expect_unmoved(board, run, kNoneHomed, {kJ4, kJ5, kJ6}, "before J1 to J3 are homed");
           expect_unmoved(board, run, kFirstThreeHomed, {kJ5, kJ6}, "before J4 is homed");
         }),

    must("parol6.home.zero-at-switch",
         "A joint that reaches its switch counts 0 there and stands with speed 0 until the others "
         "of "
         "its block are there.",
         "firmware"),
    from(kHomed, Hazard::kObserve, "Joints that waited for others stood at 0.",
         [](BoardBench& board) {
           for (const auto joint : {kJ1, kJ2, kJ3}) {
             // At rest it is at its switch, or at the end of its final move.
             for (const auto& answer : record(board).with_bits(kNoneHomed)) {
               const bool waits =
                   answer.speed[joint].value == 0 && position(answer, joint) != kHoming[joint].end;
               if (!waits) continue;
               board.about("a joint that waits for the others");
               board.expect(answer, position_field(joint), 0);
             }
           }
         }),

    must("parol6.home.base-together",
         "J1, J2 and J3 begin their final moves together, once the last of them has found its "
         "switch a second time.",
         "firmware"),
    from(kHomed, Hazard::kObserve, "None went up while another sought for the second time.",
         [](BoardBench& board) {
           for (const auto& answer : record(board).with_bits(kNoneHomed)) {
             const auto seeks = [&answer](std::size_t joint) {
               return answer.speed[joint].value == kHoming[joint].slow_seek;
             };
             if (std::ranges::none_of(kBaseJoints, seeks)) continue;
             for (const auto joint : kBaseJoints) {
               board.about("while a joint seeks its switch for the second time");
               board.expect_between(answer, speed_field(joint), kHoming[joint].slow_seek, 0);
             }
           }
         }),

    must("parol6.home.back-off",
         "J1, J2 and J3 back off from their switches to 850, 1050 and 1050.", "firmware"),
    from(kHomed, Hazard::kObserve, "J1 to J3 backed off as far as they should.",
         [](BoardBench& board) {
           expect_back_off(board, kNoneHomed, kJ2);
           expect_back_off(board, kNoneHomed, kJ3);
           auto furthest = 0;
           const auto speed = kHoming[kJ2].back_off;
           for (const auto& answer : record(board).with_speed(kNoneHomed, kJ2, speed)) {
             furthest = std::max(furthest, position(answer, kJ1));
           }
           board.expect_true(furthest == kHoming[kJ1].back_off_to,
                             "j1 to wait at 850 while J2 and J3 back off",
                             fmt::format("it goes to {}", furthest));
         }),

    must("parol6.home.back-off-speeds",
         "J2 and J3 back off at 2050; J1 backs off forward too although its speed is reported as "
         "-2050.",
         "firmware: only the magnitude matters there"),
    from(kHomed, Hazard::kObserve, "J1 showed -2050 while J2 and J3 showed 2050.",
         [](BoardBench& board) {
           const auto answers = record(board).with_speed(kNoneHomed, kJ2, kHoming[kJ2].back_off);
           board.about("while J2 backs off");
           if (answers.empty()) return board.fail("speed.j2 = 2050 for a while", "never");
           for (const auto& answer : answers) {
             board.expect(answer, "speed.j1", kHoming[kJ1].back_off);
             board.expect(answer, "speed.j3", kHoming[kJ3].back_off);
           }
         }),

    must("parol6.home.slow-speeds", "J1, J2 and J3 seek their switches a second time at -750.",
         "firmware"),
    from(kHomed, Hazard::kObserve, "J1 to J3 sought a second time at -750.",
         [](BoardBench& board) {
           for (const auto joint : {kJ1, kJ2, kJ3}) {
             const auto slow = kHoming[joint].slow_seek;
             const auto answers = record(board).with_speed(kNoneHomed, joint, slow);
             board.about("the second seek");
             if (answers.size() < 10) {
               return board.fail(fmt::format("speed.j{} = {} for about a second", joint + 1, slow),
                                 fmt::format("{} answers show it", answers.size()));
             }
             expect_speed(board, {answers.front(), answers.back()}, joint, slow);
           }
         }),

    must("parol6.home.final-j1-j3",
         "J1, J2 and J3 end at 13500, 19588 and 23020 from their switches and wait there.",
         "firmware"),
    from(kHomed, Hazard::kObserve, "J1 to J3 stood at their final positions.",
         [](BoardBench& board) {
           for (const auto homed : {kFirstThreeHomed, kFirstFourHomed}) {
             for (const auto joint : {kJ1, kJ2, kJ3}) expect_rest(board, homed, joint);
           }
         }),

    must("parol6.home.ramp-j1-j3",
         "The final moves of J1, J2 and J3 accelerate with 4500, 3000 and 5000 steps/s^2.",
         "firmware, vectors S1 to S3"),
    from(kHomed, Hazard::kObserve, "J1 to J3 accelerated as they should.",
         [](BoardBench& board) {
           for (const auto joint : {kJ1, kJ2, kJ3}) expect_final_ramp(board, kNoneHomed, joint);
         }),

    must("parol6.home.speeds-j4", "J4 seeks at 5550, backs off with -4050, seeks again at 4050.",
         "firmware"),
    from(kHomed, Hazard::kObserve, "J4 had its three speeds.",
         [](BoardBench& board) { expect_speeds(board, kFirstThreeHomed, kJ4); }),

    must("parol6.home.back-off-j4", "J4 backs off to -1550.", "firmware"),
    from(kHomed, Hazard::kObserve, "J4 backed off to -1550.",
         [](BoardBench& board) { expect_back_off(board, kFirstThreeHomed, kJ4); }),

    must("parol6.home.final-j4",
         "J4 ends at -10200 from its switch and waits there; its homed bit comes with that.",
         "firmware"),
    from(kHomed, Hazard::kObserve, "J4 stood at -10200.",
         [](BoardBench& board) { expect_rest(board, kFirstFourHomed, kJ4); }),

    must("parol6.home.ramp-j4", "The final move of J4 accelerates with 5500 steps/s^2.",
         "firmware, vector S4"),
    from(kHomed, Hazard::kObserve, "J4 accelerated as it should.",
         [](BoardBench& board) { expect_final_ramp(board, kFirstThreeHomed, kJ4); }),

    must("parol6.home.speeds-j6", "J6 seeks at -9550, backs off with 4050, seeks again at -8050.",
         "firmware"),
    from(kHomed, Hazard::kObserve, "J6 had its three speeds.",
         [](BoardBench& board) { expect_speeds(board, kFirstFourHomed, kJ6); }),

    must("parol6.home.back-off-j6", "J6 backs off to 1550.", "firmware"),
    from(kHomed, Hazard::kObserve, "J6 backed off to 1550.",
         [](BoardBench& board) { expect_back_off(board, kFirstFourHomed, kJ6); }),

    must("parol6.home.parks-j6",
         "J6 parks at 15900 from its switch, without its homed bit, while J5 seeks.", "firmware"),
    from(kHomed, Hazard::kObserve, "J6 stood at 15900, not homed, while J5 sought.",
         [](BoardBench& board) {
           const auto answers =
               record(board).with_speed(kFirstFourHomed, kJ5, kHoming[kJ5].slow_seek);
           board.about("while J5 seeks a second time");
           if (answers.empty()) return board.fail("such answers", "none");
           for (const auto& answer : answers) {
             board.expect(answer, "position.j6", kParkingJ6);
             board.expect_bits(answer, "homed", flag(kJ6), 0);
           }
         }),

    must("parol6.home.ramp-j6", "J6 accelerates with 10500 steps/s^2 on its way to park.",
         "firmware, vector S5"),
    from(kHomed, Hazard::kObserve, "J6 accelerated as it should.",
         [](BoardBench& board) {
           expect_ramp(board, kFirstFourHomed, kJ6, 0, kParkingJ6, kParkingAccelerationJ6);
         }),

    must("parol6.home.speeds-j5", "J5 seeks at -5050, backs off with 4050, seeks again at -4050.",
         "firmware"),
    from(kHomed, Hazard::kObserve, "J5 had its three speeds.",
         [](BoardBench& board) { expect_speeds(board, kFirstFourHomed, kJ5); }),

    must("parol6.home.back-off-j5", "J5 backs off to 1550.", "firmware"),
    from(kHomed, Hazard::kObserve, "J5 backed off to 1550.",
         [](BoardBench& board) { expect_back_off(board, kFirstFourHomed, kJ5); }),

    must("parol6.home.ramp-j5",
         "The final moves of J5 and of J6 on its return accelerate with 5500 steps/s^2.",
         "firmware, vectors S6 and S7"),
    from(kHomed, Hazard::kObserve, "J5 and the returning J6 accelerated as they should.",
         [](BoardBench& board) {
           expect_final_ramp(board, kFirstFourHomed, kJ5);
           expect_ramp(board, kFirstFourHomed, kJ6, kParkingJ6, kHoming[kJ6].end,
                       kHoming[kJ6].acceleration);
         }),

    must("parol6.home.returns-j6",
         "J6 returns from its parking position while J5 makes its final move.", "firmware"),
    from(kHomed, Hazard::kObserve, "J6 came back while J5 went to its place.",
         [](BoardBench& board) {
           int together = 0;
           for (const auto& answer : record(board).with_bits(kFirstFourHomed)) {
             const bool j5_on_its_way =
                 position(answer, kJ5) > 1600 && position(answer, kJ5) < kHoming[kJ5].end;
             const bool j6_on_its_way =
                 position(answer, kJ6) > 0 && position(answer, kJ6) < kParkingJ6;
             together += j5_on_its_way && j6_on_its_way && answer.speed[kJ5].value > 0 &&
                                 answer.speed[kJ6].value < 0
                             ? 1
                             : 0;
           }
           board.expect_true(together > 5, "J5 going up while J6 goes down",
                             fmt::format("{} answers show it", together));
         }),

    must("parol6.home.last-bits",
         "The homed bits of J5 and J6 come together, when both have arrived.", "firmware"),
    from(kHomed, Hazard::kObserve, "The last two homed bits came together.",
         [](BoardBench& board) {
           const auto seen = record(board).bits();
           const bool is_together = std::ranges::none_of(
               seen, [](std::uint8_t homed) { return homed == 0xFB || homed == 0xF7; });
           board.expect_true(is_together && !seen.empty() && seen.back() == kAllHomed,
                             "J5 and J6 homed in the same answer", "one came without the other");
         }),

    must("parol6.home.counters",
         "At the end of homing the counters are set to 10240, -32000, 57905, 0, 0, 32000.",
         "firmware"),
    from(kHomed, Hazard::kObserve, "The counters jumped to the standby position.",
         [](BoardBench& board) {
           for (std::size_t j = 0; j < kJointCount; ++j) {
             board.about("the first answer that has all joints homed");
             board.expect(record(board).last(), position_field(j), kStandby[j].value);
           }
         }),

    must("parol6.home.rests", "After homing all speeds are 0 and no joint moves.", "firmware"),
    from(kHomed, Hazard::kObserve, "All speeds were 0 at the end.",
         [](BoardBench& board) { expect_reported(board, record(board).last(), {}); }),

    must("parol6.home.final-j5-j6",
         "J5 ends at 8900 from its switch and waits there for J6, which ends at 0.", "firmware"),
    from(kHomed, Hazard::kHome, "At the end J5 was at 8900 and J6 at 0.",
         [](BoardBench& board) {
           const HomingRecord record{board.homing_log()};
           const auto before_end = record.with_bits(kFirstFourHomed);
           if (before_end.empty()) return board.leave_open("homing was too fast to be seen");
           board.about("the last answer before the end of homing");
           board.expect(before_end.back(), "position.j5", kHoming[kJ5].end);
           board.expect_between(before_end.back(), "position.j6", 0, 20);
         }),
};

}  // namespace

Chapter home_run_chapter() { return chapter("Homing, a whole run", kHomeRunClauses); }

}  // namespace armjig::parol6::conformance
