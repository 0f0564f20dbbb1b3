// SPDX-License-Identifier: Apache-2.0
// Cases about the run of homing that brought the arm to its start state; none moves it again.
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

HomingRecord record(BoardBench& board) { return HomingRecord{board.homing_log()}; }

std::int32_t position(const Answer& answer, std::size_t joint) {
  return answer.position[joint].value;
}

void once(BoardBench& board) { board.expect_bits(record(board).last(), "homed", 0xFC, 0xFC); }

void order(BoardBench& board) {
  const auto run = record(board);
  for (const auto& answer : run.with_bits(kNoneHomed)) {
    board.about("before J1 to J3 are homed");
    board.expect_same(answer, "position.j4", run.first());
  }
  for (const auto& answer : run.with_bits(kFirstThreeHomed)) {
    board.about("before J4 is homed");
    board.expect_same(answer, "position.j6", run.first());
  }
  for (const auto& answer : run.with_speed(kFirstFourHomed, kJ6, -9550)) {
    board.about("while J6 seeks");
    board.expect_same(answer, "position.j5", run.first());
  }
}

void bits(BoardBench& board) {
  const auto seen = record(board).bits();
  constexpr std::uint8_t kWanted[] = {kNoneHomed, kFirstThreeHomed, kFirstFourHomed, kAllHomed};
  std::string text;
  for (const auto value : seen) text += fmt::format(" {:02X}", value);
  board.expect_true(std::ranges::equal(seen, kWanted), "homed = 03 E3 F3 FF, one after the other",
                    "homed =" + text);
}

void seek_speeds(BoardBench& board) {
  expect_reported(board, record(board).first(), {-2050, -2550, -2550, 5550, -5050, -9550});
}

void seek_motion(BoardBench& board) {
  constexpr int kSeek[] = {-2050, -2550, -2550};
  for (const auto joint : {kJ1, kJ2, kJ3}) {
    auto seeking = record(board).with_speed(kNoneHomed, joint, kSeek[joint]);
    // J1 has this speed also while it backs off.
    const auto turned = std::ranges::adjacent_find(seeking, [&](const auto& a, const auto& b) {
      return position(b, joint) > position(a, joint);
    });
    seeking.erase(turned == seeking.end() ? turned : turned + 1, seeking.end());
    if (seeking.size() < 10) continue;
    board.about("the first seek");
    expect_speed(board, {seeking.front(), seeking.back()}, joint, kSeek[joint]);
  }
}

void waits_for_turn(BoardBench& board) {
  const auto run = record(board);
  for (const auto& answer : run.with_bits(kNoneHomed)) {
    for (const auto joint : {kJ4, kJ5, kJ6}) {
      board.about("before J1 to J3 are homed");
      board.expect_same(answer, position_field(joint), run.first());
    }
  }
  for (const auto& answer : run.with_bits(kFirstThreeHomed)) {
    for (const auto joint : {kJ5, kJ6}) {
      board.about("before J4 is homed");
      board.expect_same(answer, position_field(joint), run.first());
    }
  }
}

void zero_at_switch(BoardBench& board) {
  for (const auto joint : {kJ1, kJ2, kJ3}) {
    // At rest it is at its switch, or at the end of its final move.
    constexpr int kFinal[] = {13'500, 19'588, 23'020};
    for (const auto& answer : record(board).with_bits(kNoneHomed)) {
      const bool waits = answer.speed[joint].value == 0 && position(answer, joint) != kFinal[joint];
      if (!waits) continue;
      board.about("a joint that waits for the others");
      board.expect(answer, position_field(joint), 0);
    }
  }
}

/// The highest (or lowest) position while the joint backs off: the target, or as little short of it
/// as it went between two answers.
void expect_back_off(BoardBench& board, std::uint8_t homed, std::size_t joint, int speed,
                     int target) {
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
      std::chrono::duration<double>(longest + board.noise() + BoardBench::kFramePeriod).count() *
      std::abs(speed);
  board.expect_true(furthest <= target * sign && furthest >= target * sign - missed,
                    fmt::format("j{} to go to {}, seen from {:.0f} on", joint + 1, target,
                                target - sign * missed),
                    fmt::format("it goes to {}", furthest * sign));
}

void back_off(BoardBench& board) {
  expect_back_off(board, kNoneHomed, kJ2, 2050, 1050);
  expect_back_off(board, kNoneHomed, kJ3, 2050, 1050);
  auto furthest = 0;
  for (const auto& answer : record(board).with_speed(kNoneHomed, kJ2, 2050)) {
    furthest = std::max(furthest, position(answer, kJ1));
  }
  board.expect_true(furthest == 850, "j1 to wait at 850 while J2 and J3 back off",
                    fmt::format("it goes to {}", furthest));
}

void back_off_speeds(BoardBench& board) {
  const auto answers = record(board).with_speed(kNoneHomed, kJ2, 2050);
  board.about("while J2 backs off");
  if (answers.empty()) return board.fail("speed.j2 = 2050 for a while", "never");
  for (const auto& answer : answers) {
    board.expect(answer, "speed.j1", -2050);
    board.expect(answer, "speed.j3", 2050);
  }
}

void slow_speeds(BoardBench& board) {
  for (const auto joint : {kJ1, kJ2, kJ3}) {
    const auto answers = record(board).with_speed(kNoneHomed, joint, -750);
    board.about("the second seek");
    if (answers.size() < 10) {
      return board.fail(fmt::format("speed.j{} = -750 for about a second", joint + 1),
                        fmt::format("{} answers show it", answers.size()));
    }
    expect_speed(board, {answers.front(), answers.back()}, joint, -750);
  }
}

void expect_rest(BoardBench& board, std::uint8_t homed, std::size_t joint, int where) {
  const auto answers = record(board).with_bits(homed);
  board.about(fmt::format("while homed is {:02X}", homed));
  if (answers.empty()) return board.fail("such answers", "none");
  for (const auto& answer : answers) board.expect(answer, position_field(joint), where);
}

void final_j1_j3(BoardBench& board) {
  for (const auto homed : {kFirstThreeHomed, kFirstFourHomed}) {
    expect_rest(board, homed, kJ1, 13'500);
    expect_rest(board, homed, kJ2, 19'588);
    expect_rest(board, homed, kJ3, 23'020);
  }
}

void final_j4(BoardBench& board) { expect_rest(board, kFirstFourHomed, kJ4, -10'200); }

/// On a ramp from rest at `from` the square of the speed is twice the acceleration times the way:
/// judged at a quarter of the way, where neither the first steps nor the maximum matter much.
void expect_ramp(BoardBench& board, std::uint8_t homed, std::size_t joint, int from, int to,
                 double acceleration) {
  constexpr double kTolerance = 0.03;
  int judged = 0;
  const auto sign = to > from ? 1 : -1;
  for (const auto& answer : record(board).with_bits(homed)) {
    const auto way = (position(answer, joint) - from) * sign;
    const auto speed = answer.speed[joint].value * sign;
    const bool is_speeding_up = way > 200 && way < std::abs(to - from) / 3 && speed > 0;
    // What homing sets before and after a ramp has the same positions, but not such speeds.
    const bool is_set = speed == 2050 || speed == 4050 || speed == 5550 || speed == 1050;
    if (!is_speeding_up || is_set) continue;
    ++judged;
    const auto wanted = std::sqrt(2 * acceleration * way);
    board.about(fmt::format("j{} {} steps into its final move", joint + 1, way));
    board.expect_true(std::abs(speed - wanted) <= kTolerance * wanted + 20,
                      fmt::format("a speed of {:.0f} steps/s", wanted),
                      fmt::format("{} steps/s", speed));
  }
  board.expect_true(judged >= 3, fmt::format("j{} to make a final move on a ramp", joint + 1),
                    fmt::format("{} answers show it", judged));
}

void ramp_j1_j3(BoardBench& board) {
  expect_ramp(board, kNoneHomed, kJ1, 0, 13'500, 4500);
  expect_ramp(board, kNoneHomed, kJ2, 0, 19'588, 3000);
  expect_ramp(board, kNoneHomed, kJ3, 0, 23'020, 5000);
}

void ramp_j4(BoardBench& board) { expect_ramp(board, kFirstThreeHomed, kJ4, 0, -10'200, 5500); }
void ramp_j6(BoardBench& board) { expect_ramp(board, kFirstFourHomed, kJ6, 0, 15'900, 10'500); }

void ramp_j5(BoardBench& board) {
  expect_ramp(board, kFirstFourHomed, kJ5, 0, 8900, 5500);
  expect_ramp(board, kFirstFourHomed, kJ6, 15'900, 0, 5500);
}

/// The first seek is that short or longer as the arm stood; the other two have their length.
void expect_speeds(BoardBench& board, std::uint8_t homed, std::size_t joint, int seek, int back_off,
                   int slow) {
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

void speeds_j4(BoardBench& board) {
  expect_speeds(board, kFirstThreeHomed, kJ4, 5550, -4050, 4050);
}
void speeds_j6(BoardBench& board) {
  expect_speeds(board, kFirstFourHomed, kJ6, -9550, 4050, -8050);
}
void speeds_j5(BoardBench& board) {
  expect_speeds(board, kFirstFourHomed, kJ5, -5050, 4050, -4050);
}

void back_off_j4(BoardBench& board) { expect_back_off(board, kFirstThreeHomed, kJ4, -4050, -1550); }
void back_off_j6(BoardBench& board) { expect_back_off(board, kFirstFourHomed, kJ6, 4050, 1550); }
void back_off_j5(BoardBench& board) { expect_back_off(board, kFirstFourHomed, kJ5, 4050, 1550); }

void parks_j6(BoardBench& board) {
  const auto answers = record(board).with_speed(kFirstFourHomed, kJ5, -4050);
  board.about("while J5 seeks a second time");
  if (answers.empty()) return board.fail("such answers", "none");
  for (const auto& answer : answers) {
    board.expect(answer, "position.j6", 15'900);
    board.expect_bits(answer, "homed", flag(kJ6), 0);
  }
}

void returns_j6(BoardBench& board) {
  int together = 0;
  for (const auto& answer : record(board).with_bits(kFirstFourHomed)) {
    const bool j5_on_its_way = position(answer, kJ5) > 1600 && position(answer, kJ5) < 8900;
    const bool j6_on_its_way = position(answer, kJ6) > 0 && position(answer, kJ6) < 15'900;
    together +=
        j5_on_its_way && j6_on_its_way && answer.speed[kJ5].value > 0 && answer.speed[kJ6].value < 0
            ? 1
            : 0;
  }
  board.expect_true(together > 5, "J5 going up while J6 goes down",
                    fmt::format("{} answers show it", together));
}

void last_bits(BoardBench& board) {
  const auto seen = record(board).bits();
  const bool is_together =
      std::ranges::none_of(seen, [](std::uint8_t homed) { return homed == 0xFB || homed == 0xF7; });
  board.expect_true(is_together && !seen.empty() && seen.back() == kAllHomed,
                    "J5 and J6 homed in the same answer", "one came without the other");
}

void counters(BoardBench& board) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    board.about("the first answer that has all joints homed");
    board.expect(record(board).last(), position_field(j), kStandby[j].value);
  }
}

void rests(BoardBench& board) { expect_reported(board, record(board).last(), {}); }

constexpr Case kCases[] = {
    from(kHomed, Hazard::kObserve, "parol6.home.once", "One home command was enough.", on<once>),
    from(kHomed, Hazard::kObserve, "parol6.home.order", "No joint moved before its block's turn.",
         on<order>),
    from(kHomed, Hazard::kObserve, "parol6.home.bits", "homed took four values, in order.",
         on<bits>),
    from(kHomed, Hazard::kObserve, "parol6.home.seek-speeds",
         "The first answer of the run had six seek speeds.", on<seek_speeds>),
    from(kHomed, Hazard::kObserve, "parol6.home.seek-motion",
         "J1 to J3 went down as fast as they said.", on<seek_motion>),
    from(kHomed, Hazard::kObserve, "parol6.home.waits-for-turn",
         "J4 to J6 stood still at first, J5 and J6 for longer.", on<waits_for_turn>),
    from(kHomed, Hazard::kObserve, "parol6.home.zero-at-switch",
         "Joints that waited for others stood at 0.", on<zero_at_switch>),
    from(kHomed, Hazard::kObserve, "parol6.home.back-off",
         "J1 to J3 backed off as far as they should.", on<back_off>),
    from(kHomed, Hazard::kObserve, "parol6.home.back-off-speeds",
         "J1 showed -2050 while J2 and J3 showed 2050.", on<back_off_speeds>),
    from(kHomed, Hazard::kObserve, "parol6.home.slow-speeds",
         "J1 to J3 sought a second time at -750.", on<slow_speeds>),
    from(kHomed, Hazard::kObserve, "parol6.home.final-j1-j3",
         "J1 to J3 stood at their final positions.", on<final_j1_j3>),
    from(kHomed, Hazard::kObserve, "parol6.home.ramp-j1-j3", "J1 to J3 accelerated as they should.",
         on<ramp_j1_j3>),
    from(kHomed, Hazard::kObserve, "parol6.home.speeds-j4", "J4 had its three speeds.",
         on<speeds_j4>),
    from(kHomed, Hazard::kObserve, "parol6.home.back-off-j4", "J4 backed off to -1550.",
         on<back_off_j4>),
    from(kHomed, Hazard::kObserve, "parol6.home.final-j4", "J4 stood at -10200.", on<final_j4>),
    from(kHomed, Hazard::kObserve, "parol6.home.ramp-j4", "J4 accelerated as it should.",
         on<ramp_j4>),
    from(kHomed, Hazard::kObserve, "parol6.home.speeds-j6", "J6 had its three speeds.",
         on<speeds_j6>),
    from(kHomed, Hazard::kObserve, "parol6.home.back-off-j6", "J6 backed off to 1550.",
         on<back_off_j6>),
    from(kHomed, Hazard::kObserve, "parol6.home.parks-j6",
         "J6 stood at 15900, not homed, while J5 sought.", on<parks_j6>),
    from(kHomed, Hazard::kObserve, "parol6.home.ramp-j6", "J6 accelerated as it should.",
         on<ramp_j6>),
    from(kHomed, Hazard::kObserve, "parol6.home.speeds-j5", "J5 had its three speeds.",
         on<speeds_j5>),
    from(kHomed, Hazard::kObserve, "parol6.home.back-off-j5", "J5 backed off to 1550.",
         on<back_off_j5>),
    from(kHomed, Hazard::kObserve, "parol6.home.ramp-j5",
         "J5 and the returning J6 accelerated as they should.", on<ramp_j5>),
    from(kHomed, Hazard::kObserve, "parol6.home.returns-j6",
         "J6 came back while J5 went to its place.", on<returns_j6>),
    from(kHomed, Hazard::kObserve, "parol6.home.last-bits",
         "The last two homed bits came together.", on<last_bits>),
    from(kHomed, Hazard::kObserve, "parol6.home.counters",
         "The counters jumped to the standby position.", on<counters>),
    from(kHomed, Hazard::kObserve, "parol6.home.rests", "All speeds were 0 at the end.", on<rests>),
};

}  // namespace

std::span<const Case> home_run_cases() noexcept { return kCases; }

}  // namespace armjig::parol6::conformance
