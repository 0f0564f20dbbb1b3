// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr Duration kSomeSeeking = 200ms;
constexpr Speeds kSeekSpeeds{-2050, -2550, -2550, 5550, -5050, -9550};

void expect_seeks(BoardBench& board, const CommandFrame& frame) {
  expect_speed(board, run(board, frame, 100ms), 1, -2550);
}

void idle_speeds_ignored(BoardBench& board) {
  begin_homing(board, 20ms);
  const auto frame = with_speeds(255, {5, 6, 7, 8, 9, 10});
  board.about("homing, with speeds in idle frames");
  expect_seeks(board, frame);
  expect_reported(board, board.ask(frame), kSeekSpeeds);
  board.act(with_code(101));
}

void goes_on_when_repeated(BoardBench& board) {
  board.act(with_code(100));
  board.about("homing, with the home command in every frame");
  expect_seeks(board, with_code(100));
  expect_reported(board, board.ask(with_code(100)), kSeekSpeeds);
  board.act(with_code(101));
}

void paused(BoardBench& board) {
  begin_homing(board, 50ms);
  board.act(with_code(42));
  board.about("homing, then code 42");
  expect_still(board, with_code(42), 100ms);
  board.act(idle());
  board.about("homing, then code 42, then idle");
  expect_seeks(board, idle());
  board.act(with_code(101));
}

/// Homing that a frame has ended stays ended.
void expect_ended(BoardBench& board, const CommandFrame& frame) {
  begin_homing(board, kSomeSeeking);
  board.act(frame);
  board.act(idle());
  board.about(fmt::format("homing, then code {}, then idle", static_cast<int>(frame.command)));
  expect_still(board, idle(), 150ms);
}

void ended_by_enable(BoardBench& board) { expect_ended(board, with_code(101)); }
void ended_by_clear(BoardBench& board) { expect_ended(board, with_code(103)); }

void ended_by_disable(BoardBench& board) {
  expect_ended(board, with_code(102));
  board.act(with_code(101));
  board.about("homing, then disable, then enable, then idle");
  expect_still(board, idle(), 150ms);
}

void ended_by_jog(BoardBench& board) {
  expect_ended(board, jog({}));
  board.act(with_code(101));
}

void ended_by_go_to(BoardBench& board) {
  begin_homing(board, kSomeSeeking);
  board.act(with_code(42));
  const auto rest = board.ask(with_code(42));
  board.act(go_to(rest.position));
  board.act(idle());
  board.about("homing, then a go-to, then idle");
  expect_still(board, idle(), 150ms);
  board.act(with_code(101));
}

void bits_taken_back(BoardBench& board) {
  board.act(with_code(100));
  board.about("home on a homed arm");
  board.expect(board.ask(idle()), "homed", 0x03);
  board.act(with_code(101));
}

void bits_stay_away(BoardBench& board) {
  begin_homing(board, kSomeSeeking);
  for (const int code : {101, 255, 102, 103, 101}) {
    board.about(fmt::format("a run of homing that was ended, then code {}", code));
    board.act(with_code(code));
    board.expect(board.ask(with_code(code)), "homed", 0x03);
  }
  board.act(idle());
}

void bits_stay(BoardBench& board) {
  for (const int code : {101, 102, 103, 101, 42, 255}) {
    board.about(fmt::format("a homed arm, then code {}", code));
    board.act(with_code(code));
    board.expect(board.ask(with_code(code)), "homed", 0xFF);
  }
}

/// Home, which begins with the seek speeds; then enable, which ends it.
void expect_seek_speeds(BoardBench& board, std::string what) {
  board.act(with_code(100));
  board.about(std::move(what));
  expect_reported(board, board.ask(idle()), kSeekSpeeds);
  board.act(with_code(101));
}

/// A jog leaves a speed behind by which the next run can be told.
void expect_begins_anew(BoardBench& board, int code) {
  begin_homing(board, kSomeSeeking);
  board.act(jog({-500, -500, -500, 0, 0, 0}));
  board.act(with_code(code));
  expect_seek_speeds(board, fmt::format("homing, a jog, code {}, home", code));
}

void begins_anew(BoardBench& board) { expect_begins_anew(board, 101); }
void begins_anew_after_clear(BoardBench& board) { expect_begins_anew(board, 103); }

void interrupted(BoardBench& board) {
  begin_homing(board, kSomeSeeking);
  board.act(jog({-500, -600, -700, 0, 0, 0}));
  board.act(with_code(100));
  board.about("homing, a jog at -500, home");
  const auto stretch = run(board, idle(), 100ms);
  expect_reported(board, stretch.after, {-500, -600, -700, 0, 0, 0});
  expect_speed(board, stretch, 0, -500);
  board.act(with_code(101));
}

void afresh(BoardBench& board) {
  for (const int code : {123, 102}) {
    begin_homing(board, kSomeSeeking);
    board.act(code == 123 ? jog({-500, -600, -700, 0, 0, 0}) : with_code(code));
    if (code == 102) board.act(with_code(101));
    expect_seek_speeds(board, fmt::format("homing, code {}, home", code));
  }
}

/// J1 has hit its switch, J2 and J3 have not; then enable and home.
Stretch after_one_switch(BoardBench& board) {
  board.spoil();
  board.touch("position.j1", -2900);
  board.touch("position.j2", -32'000);
  board.touch("position.j3", 57'905);
  board.act(with_code(100));
  const auto has_hit = [](const Answer& answer) {
    return answer.speed[0].value == 0 && answer.position[0].value == 0;
  };
  board.about("homing with J1 near its switch");
  if (!board.ask_until(idle(), has_hit, 3s)) board.fail("j1 to hit its switch", "it does not");
  board.touch("position.j1", 10'240);
  board.act(with_code(101));
  board.act(with_code(100));
  board.about("the run behind one that had seen the switch of J1 only");
  return run(board, idle(), 200ms);
}

void seen_stays(BoardBench& board) {
  const auto stretch = after_one_switch(board);
  board.expect_same(stretch.after, "position.j1", stretch.before);
  expect_speed(board, stretch, 1, -2550);
}

void seen_forgotten(BoardBench& board) {
  const auto stretch = after_one_switch(board);
  expect_speed(board, stretch, 0, -2050);
  expect_speed(board, stretch, 1, -2550);
}

void pressed_at_start(BoardBench& board) {
  board.spoil();
  board.touch("switch.j1", 1);
  board.act(with_code(100));
  board.about("homing with the switch of J1 stuck closed");
  const auto stretch = run(board, idle(), 100ms);
  board.expect(stretch.after, "position.j1", 0);
  board.expect(stretch.after, "speed.j1", 0);
  expect_speed(board, stretch, 1, -2550);
  board.touch("switch.j1", 0);
}

void no_timeout(BoardBench& board) {
  board.spoil();
  board.touch("switch.j1", 2);
  board.act(with_code(100));
  board.keep_asking(idle(), 60s);
  board.about("a minute of homing with the switch of J1 stuck open");
  expect_speed(board, run(board, idle(), 100ms), 0, -2050);
  board.touch("switch.j1", 0);
  board.touch("position.j1", 10'240);
}

void again(BoardBench& board) {
  board.act(with_code(100));
  board.about("homing a homed arm");
  const auto is_done = [](const Answer& answer) { return is_homed(answer); };
  board.expect_true(board.ask_until(idle(), is_done, 90s).has_value(), "all joints homed",
                    "not within 90 s");
}

constexpr std::uint8_t kFourHomed = 0xF3;

/// Holds the home command until the run behind the first one has begun, or for 90 s.
Answer hold_home(BoardBench& board) {
  board.act(with_code(100));
  const auto is_near_the_end = [](const Answer& answer) { return answer.homed == kFourHomed; };
  const auto is_over = [](const Answer& answer) { return answer.homed != kFourHomed; };
  (void)board.ask_until(with_code(100), is_near_the_end, 90s);
  (void)board.ask_until(with_code(100), is_over, 90s);
  board.about("home, held until all joints were homed");
  return board.keep_asking(with_code(100), 100ms);
}

void held(BoardBench& board) {
  board.expect(hold_home(board), "homed", 0x03);
  board.act(with_code(101));
}

void held_once(BoardBench& board) {
  board.expect(hold_home(board), "homed", 0xFF);
  expect_still(board, with_code(100), 200ms);
  board.act(with_code(101));
}

constexpr Case kCases[] = {
    from(kEnabled, Hazard::kHome, "parol6.home.idle-speeds-ignored",
         "J2 seeks at its speed whatever idle frames say.", on<idle_speeds_ignored>),
    from(kEnabled, Hazard::kHome, "parol6.home.goes-on-when-repeated",
         "J2 seeks while the home command is repeated.", on<goes_on_when_repeated>),
    from(kEnabled, Hazard::kHome, "parol6.home.paused", "Code 42 pauses homing, idle resumes it.",
         on<paused>),
    from(kEnabled, Hazard::kHome, "parol6.home.ended-by-enable",
         "Idle does not resume homing after enable.", on<ended_by_enable>),
    from(kEnabled, Hazard::kHome, "parol6.home.ended-by-disable",
         "Idle does not resume homing after disable, nor after enable.", on<ended_by_disable>),
    from(kEnabled, Hazard::kHome, "parol6.home.ended-by-clear",
         "Idle does not resume homing after clear error.", on<ended_by_clear>),
    from(kEnabled, Hazard::kHome, "parol6.home.ended-by-jog",
         "Idle does not resume homing after a jog.", on<ended_by_jog>),
    from(kEnabled, Hazard::kHome, "parol6.home.ended-by-go-to",
         "Idle does not resume homing after a go-to.", on<ended_by_go_to>),
    full(from(kHomed, Hazard::kHome, "parol6.home.bits-taken-back",
              "A homed arm that homes again is not homed.", on<bits_taken_back>)),
    from(kEnabled, Hazard::kHome, "parol6.home.bits-stay-away",
         "No homed bit returns after homing was ended.", on<bits_stay_away>),
    from(kHomed, Hazard::kState, "parol6.home.bits-stay",
         "A homed arm stays homed through six codes.", on<bits_stay>),
    from(kEnabled, Hazard::kHome, "parol6.home.begins-anew",
         "Home after enable sets the seek speeds.", on<begins_anew>),
    from(kEnabled, Hazard::kHome, "parol6.home.begins-anew-after-clear",
         "Home after clear error sets the seek speeds.", on<begins_anew_after_clear>),
    from(kEnabled, Hazard::kHome, "parol6.home.interrupted",
         "Home after a jog seeks at the jog's speeds.", on<interrupted>),
    from(kEnabled, Hazard::kHome, "parol6.home.afresh",
         "Home after a jog, or after disable and enable, sets the seek speeds.", on<afresh>),
    from(kEnabled, Hazard::kHome, "parol6.home.seen-stays",
         "J1 does not seek its switch in the run behind an ended one.", on<seen_stays>),
    from(kEnabled, Hazard::kHome, "parol6.home.seen-forgotten",
         "J1 seeks its switch in the run behind an ended one.", on<seen_forgotten>),
    from(kEnabled, Hazard::kHome, "parol6.home.pressed-at-start",
         "J1 does not move with its switch stuck closed.", on<pressed_at_start>),
    full(from(kEnabled, Hazard::kHome, "parol6.home.no-timeout", "J1 still seeks after a minute.",
              on<no_timeout>)),
    full(from(kHomed, Hazard::kHome, "parol6.home.again", "A homed arm homes a second time.",
              on<again>)),
    full(from(kHomed, Hazard::kHome, "parol6.home.held",
              "All joints are unhomed again 100 ms after the end of homing.", on<held>)),
    full(from(kHomed, Hazard::kHome, "parol6.home.held-once",
              "All joints stay homed and stand after the end of homing.", on<held_once>)),
};

}  // namespace

std::span<const Case> home_cases() noexcept { return kCases; }

}  // namespace armjig::parol6::conformance
