// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr Duration kSomeSeeking = 200ms;

void expect_seeks(BoardBench& board, const CommandFrame& frame) {
  expect_speed(board, run(board, frame, 100ms), kJ2, kHoming[kJ2].seek);
}

/// Homing that a frame has ended stays ended.
void expect_ended(BoardBench& board, const CommandFrame& frame) {
  begin_homing(board, kSomeSeeking);
  board.act(frame);
  board.act(idle());
  board.about(fmt::format("homing, then code {}, then idle", static_cast<int>(frame.command)));
  expect_still(board, idle(), 150ms);
}

/// Home, which begins with the seek speeds; then enable, which ends it.
void expect_seek_speeds(BoardBench& board, std::string what) {
  board.act(with_code(kHome));
  board.about(std::move(what));
  expect_reported(board, board.ask(idle()), seek_speeds());
  board.act(with_code(kEnable));
}

/// A jog leaves a speed behind by which the next run can be told.
void expect_begins_anew(BoardBench& board, int code) {
  begin_homing(board, kSomeSeeking);
  board.act(jog({-500, -500, -500, 0, 0, 0}));
  board.act(with_code(code));
  expect_seek_speeds(board, fmt::format("homing, a jog, code {}, home", code));
}

/// J1 has hit its switch, J2 and J3 have not; then enable and home.
Stretch after_one_switch(BoardBench& board) {
  board.spoil();
  board.touch("position.j1", -2900);
  board.touch("position.j2", -32'000);
  board.touch("position.j3", 57'905);
  board.act(with_code(kHome));
  const auto has_hit = [](const Answer& answer) {
    return answer.speed[0].value == 0 && answer.position[0].value == 0;
  };
  board.about("homing with J1 near its switch");
  if (!board.ask_until(idle(), has_hit, 3s)) board.fail("j1 to hit its switch", "it does not");
  board.touch("position.j1", 10'240);
  board.act(with_code(kEnable));
  board.act(with_code(kHome));
  board.about("the run after one that had seen the switch of J1 only");
  return run(board, idle(), 200ms);
}

/// In a run of homing the command comes again when three joints are homed.
void expect_goes_on_later(BoardBench& board) {
  board.act(with_code(kHome));
  board.about("homing, until three joints are homed");
  const auto are_three = [](const Answer& answer) { return answer.homed == kFirstThreeHomed; };
  const auto three = board.ask_until(idle(), are_three, 60s);
  if (!three) return board.fail("homed = E3 within 60 s", "never");
  board.act(with_code(kHome));
  board.about("the home command, again");
  const auto later = board.keep_asking(idle(), 300ms);
  board.expect(later, "homed", kFirstThreeHomed);
  for (const auto joint : {kJ1, kJ2, kJ3}) {
    board.expect_same(later, position_field(joint), *three);
  }
  if (!board.ask_until(idle(), [](const Answer& answer) { return is_homed(answer); }, 90s)) {
    board.fail("all joints homed", "not in 90 s");
  }
}

constexpr std::uint8_t kFourHomed = 0xF3;

/// Holds the home command until the run behind the first one has begun, or for 90 s.
Answer hold_home(BoardBench& board) {
  board.act(with_code(kHome));
  const auto is_near_the_end = [](const Answer& answer) { return answer.homed == kFourHomed; };
  const auto is_over = [](const Answer& answer) { return answer.homed != kFourHomed; };
  (void)board.ask_until(with_code(kHome), is_near_the_end, 90s);
  (void)board.ask_until(with_code(kHome), is_over, 90s);
  board.about("home, held until all joints were homed");
  return board.keep_asking(with_code(kHome), 100ms);
}

/// Homes an arm that was homed, while `look` asks until the answer is that of an arm that is. All
/// answers.
template <class Look>
std::vector<Answer> home_again(BoardBench& board, Look look) {
  std::vector<Answer> log{board.ask(idle())};
  board.act(with_code(kHome));
  look([&](const Answer& answer) {
    log.push_back(answer);
    return is_homed(answer);
  });
  return log;
}

/// One joint after the other, to the same places as the first time.
void expect_as_first(BoardBench& board, const Answer& first, const std::vector<Answer>& log) {
  const std::vector wanted{kNoneHomed, kFirstThreeHomed, kFirstFourHomed, kAllHomed};
  board.expect_true(HomingRecord{log}.bits() == wanted, "homed = 03 E3 F3 FF, one after the other",
                    "others");
  for (std::size_t j = 0; j < kJointCount; ++j) {
    board.expect_same(log.back(), position_field(j), first);
  }
}

/// The same stages as the first time, to the same places, and each joint at its switch again.
void expect_second_run(BoardBench& board) {
  const auto first = board.homing_log().back();
  const auto log = home_again(board, [&](auto is_over) {
    board.about("homing a homed arm");
    if (!board.ask_until(idle(), is_over, 90s)) board.fail("all joints homed", "not in 90 s");
  });
  expect_as_first(board, first, log);
  const HomingRecord run{log};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto bits = j < 3 ? kNoneHomed : j == 3 ? kFirstThreeHomed : kFirstFourHomed;
    for (const auto speed : {kHoming[j].back_off, kHoming[j].slow_seek}) {
      board.expect_true(run.with_speed(bits, j, speed).size() > 2,
                        fmt::format("{} = {} for a while", speed_field(j), speed), "never");
    }
  }
}

/// Pauses leave out nothing and add nothing, whatever is under way.
void expect_paused_run(BoardBench& board) {
  const auto first = board.homing_log().back();
  const auto end = board.now() + 120s;
  const auto log = home_again(board, [&](auto is_over) {
    while (!board.is_over() && !board.error() && board.now() < end) {
      if (board.ask_until(idle(), is_over, 300ms)) break;
      board.act(with_code(42));
      board.about("code 42 in a run of homing");
      expect_still(board, with_code(42), 20ms);
      board.act(idle());
    }
  });
  board.about("a run of homing with pauses");
  expect_as_first(board, first, log);
}

constexpr Clause kHomeClauses[] = {
    must("parol6.home.idle-speeds-ignored", "Speeds in idle frames do not disturb homing.",
         "firmware: 255 leaves them alone"),
    from(kEnabled, Hazard::kHome, "J2 seeks at its speed whatever idle frames say.",
         [](BoardBench& board) {
           begin_homing(board, 20ms);
           const auto frame = with_speeds(255, {5, 6, 7, 8, 9, 10});
           board.about("homing, with speeds in idle frames");
           expect_seeks(board, frame);
           expect_reported(board, board.ask(frame), seek_speeds());
           board.act(with_code(kEnable));
         }),

    must("parol6.home.goes-on-when-repeated",
         "A home command that comes again while the arm homes goes on with it.", "firmware"),
    from(kEnabled, Hazard::kHome, "J2 seeks while the home command is repeated.",
         [](BoardBench& board) {
           board.act(with_code(kHome));
           board.about("homing, with the home command in every frame");
           expect_seeks(board, with_code(kHome));
           expect_reported(board, board.ask(with_code(kHome)), seek_speeds());
           board.act(with_code(kEnable));
         }),
    variant("later",
            full(from(kHomed, Hazard::kHome, "J1 to J3 stay homed when it comes after them.",
                      [](BoardBench& board) { expect_goes_on_later(board); }))),

    must("parol6.home.paused",
         "A code without a meaning pauses homing, and the next idle frame resumes it.",
         "firmware, vector B9"),
    from(kEnabled, Hazard::kHome, "Code 42 pauses homing, idle resumes it.",
         [](BoardBench& board) {
           begin_homing(board, 50ms);
           board.act(with_code(42));
           board.about("homing, then code 42");
           expect_still(board, with_code(42), 100ms);
           board.act(idle());
           board.about("homing, then code 42, then idle");
           expect_seeks(board, idle());
           board.act(with_code(kEnable));
         }),

    variant("every-stage", full(from(kHomed, Hazard::kHome,
                                     "A run that code 42 pauses every 300 ms ends like any other.",
                                     on<expect_paused_run>))),

    must("parol6.home.ended-by-enable", "Enable ends homing: idle frames do not resume it.",
         "firmware"),
    from(kEnabled, Hazard::kHome, "Idle does not resume homing after enable.",
         [](BoardBench& board) { expect_ended(board, with_code(kEnable)); }),

    must("parol6.home.ended-by-disable",
         "Disable ends homing: idle frames do not resume it, also not after enable.", "firmware"),
    from(kEnabled, Hazard::kHome, "Idle does not resume homing after disable, nor after enable.",
         [](BoardBench& board) {
           expect_ended(board, with_code(kDisable));
           board.act(with_code(kEnable));
           board.about("homing, then disable, then enable, then idle");
           expect_still(board, idle(), 150ms);
         }),

    must("parol6.home.ended-by-clear", "Clear error ends homing: idle frames do not resume it.",
         "firmware"),
    from(kEnabled, Hazard::kHome, "Idle does not resume homing after clear error.",
         [](BoardBench& board) { expect_ended(board, with_code(kClearError)); }),
    variant("leaves-enabled", from(kHomed, Hazard::kHome, "J5 jogs after clear error in homing.",
                                   [](BoardBench& board) {
                                     begin_homing(board, 100ms);
                                     board.act(with_code(kClearError));
                                     board.about("a jog after clear error in homing");
                                     expect_moved(board, run(board, jog(4, 1000), 50ms));
                                     board.act(with_code(kEnable));
                                   })),

    must("parol6.home.ended-by-jog", "A jog ends homing: idle frames do not resume it.",
         "firmware"),
    from(kEnabled, Hazard::kHome, "Idle does not resume homing after a jog.",
         [](BoardBench& board) {
           expect_ended(board, jog({}));
           board.act(with_code(kEnable));
         }),

    variant("moving",
            from(kEnabled, Hazard::kHome, "Idle does not resume homing after a jog of J5.",
                 [](BoardBench& board) {
                   expect_ended(board, jog(4, 300));
                   board.act(with_code(kEnable));
                 })),

    must("parol6.home.ended-by-go-to", "A go-to ends homing: idle frames do not resume it.",
         "firmware"),
    from(kEnabled, Hazard::kHome, "Idle does not resume homing after a go-to.",
         [](BoardBench& board) {
           begin_homing(board, kSomeSeeking);
           board.act(go_to(rest_in_homing(board).position));
           board.act(idle());
           board.about("homing, then a go-to, then idle");
           expect_still(board, idle(), 150ms);
           board.act(with_code(kEnable));
         }),
    variant("goes", from(kHomed, Hazard::kHome, "A go-to in homing arrives.",
                         [](BoardBench& board) {
                           begin_homing(board, 100ms);
                           const auto rest = rest_in_homing(board);
                           board.about("a go-to in homing");
                           board.keep_asking(go_to(beside(rest, 4, 50)), 300ms);
                           const auto answer = board.ask(go_to(beside(rest, 4, 50)));
                           board.expect(answer, "position.j5", rest.position[4].value + 50);
                           board.act(with_code(kEnable));
                         })),

    must("parol6.home.bits-stay-away",
         "Homed bits that a run took back do not return when the run is ended.", "firmware"),
    from(kEnabled, Hazard::kHome, "No homed bit returns after homing was ended.",
         [](BoardBench& board) {
           begin_homing(board, kSomeSeeking);
           for (const int code : {101, 255, 102, 103, 101}) {
             board.about(fmt::format("a run of homing that was ended, then code {}", code));
             board.act(with_code(code));
             board.expect(board.ask(with_code(code)), "homed", 0x03);
           }
           board.act(idle());
         }),

    must("parol6.home.bits-stay",
         "Enable, disable and clear error leave the homed bits as they are.", "firmware"),
    from(kHomed, Hazard::kState, "A homed arm stays homed through six codes.",
         [](BoardBench& board) {
           for (const int code : {101, 102, 103, 101, 42, 255}) {
             board.about(fmt::format("a homed arm, then code {}", code));
             board.act(with_code(code));
             board.expect(board.ask(with_code(code)), "homed", 0xFF);
           }
         }),

    must("parol6.home.begins-anew",
         "After enable a home command begins with the seek speeds again.", "firmware"),
    from(kEnabled, Hazard::kHome, "Home after enable sets the seek speeds.",
         [](BoardBench& board) { expect_begins_anew(board, 101); }),

    must("parol6.home.begins-anew-after-clear",
         "After clear error a home command begins with the seek speeds again.", "firmware"),
    from(kEnabled, Hazard::kHome, "Home after clear error sets the seek speeds.",
         [](BoardBench& board) { expect_begins_anew(board, 103); }),

    must("parol6.home.right-after",
         "Home begins also right after a jog, a go-to or another code, with no idle frame between.",
         "document, home; firmware: each code acts in its own pass"),
    from(kEnabled, Hazard::kHome, "Home right after each of four codes sets the seek speeds.",
         [](BoardBench& board) {
           board.act(with_code(kEnable));
           const auto rest = board.ask(idle());
           for (const auto& frame :
                {jog({}), go_to(rest.position), with_code(kClearError), with_code(42)}) {
             board.act(frame);
             expect_seek_speeds(board,
                                fmt::format("code {}, home", static_cast<int>(frame.command)));
           }
         }),

    must("parol6.home.interrupted",
         "A jog or go-to keeps the stage of homing: the next home command goes on in it, at the "
         "speed "
         "that the jog left.",
         "firmware", Profiles::kFirmware, "parol6.home.afresh"),
    from(kEnabled, Hazard::kHome, "Home after a jog seeks at the jog's speeds.",
         [](BoardBench& board) {
           begin_homing(board, kSomeSeeking);
           board.act(jog({-500, -600, -700, 0, 0, 0}));
           board.act(with_code(kHome));
           board.about("homing, a jog at -500, home");
           const auto stretch = run(board, idle(), 100ms);
           expect_reported(board, stretch.after, {-500, -600, -700, 0, 0, 0});
           expect_speed(board, stretch, 0, -500);
           board.act(with_code(kEnable));
         }),

    should("parol6.home.afresh",
           "After any interruption the next home command begins with the seek speeds again.",
           "document is silent; our choice", Profiles::kDocumented, "parol6.home.interrupted"),
    from(kEnabled, Hazard::kHome,
         "Home after a jog, or after disable and enable, sets the seek speeds.",
         [](BoardBench& board) {
           for (const int code : {123, 102}) {
             begin_homing(board, kSomeSeeking);
             board.act(code == 123 ? jog({-500, -600, -700, 0, 0, 0}) : with_code(code));
             if (code == 102) board.act(with_code(kEnable));
             expect_seek_speeds(board, fmt::format("homing, code {}, home", code));
           }
         }),

    must("parol6.home.seen-stays",
         "After enable a joint that had seen its switch skips its seek in the next run.",
         "firmware", Profiles::kFirmware, "parol6.home.seen-forgotten"),
    from(kEnabled, Hazard::kHome, "J1 does not seek its switch in the run after an ended one.",
         [](BoardBench& board) {
           const auto stretch = after_one_switch(board);
           board.expect_same(stretch.after, "position.j1", stretch.before);
           expect_speed(board, stretch, kJ2, kHoming[kJ2].seek);
         }),

    should("parol6.home.seen-forgotten",
           "After enable every joint seeks its switch in the next run.",
           "document is silent; our choice", Profiles::kDocumented, "parol6.home.seen-stays"),
    from(kEnabled, Hazard::kHome, "J1 seeks its switch in the run after an ended one.",
         [](BoardBench& board) {
           const auto stretch = after_one_switch(board);
           expect_speed(board, stretch, 0, -2050);
           expect_speed(board, stretch, kJ2, kHoming[kJ2].seek);
         }),

    must("parol6.home.pressed-at-start",
         "A switch that is pressed already when homing begins counts at once.", "firmware"),
    from(kEnabled, Hazard::kHome, "J1 does not move with its switch stuck closed.",
         [](BoardBench& board) {
           board.spoil();
           board.touch("switch.j1", 1);
           board.act(with_code(kHome));
           board.about("homing with the switch of J1 stuck closed");
           const auto stretch = run(board, idle(), 100ms);
           board.expect(stretch.after, "position.j1", 0);
           board.expect(stretch.after, "speed.j1", 0);
           expect_speed(board, stretch, kJ2, kHoming[kJ2].seek);
           board.touch("switch.j1", 0);
         }),

    must("parol6.home.no-timeout", "A switch that never closes is sought for ever.",
         "firmware: nothing times out"),
    full(from(kEnabled, Hazard::kHome, "J1 still seeks after a minute.",
              [](BoardBench& board) {
                board.spoil();
                board.touch("switch.j1", 2);
                board.act(with_code(kHome));
                board.keep_asking(idle(), 60s);
                board.about("a minute of homing with the switch of J1 stuck open");
                expect_speed(board, run(board, idle(), 100ms), 0, -2050);
                board.touch("switch.j1", 0);
                board.touch("position.j1", 10'240);
              })),

    must("parol6.home.again", "A homed arm can be homed again.", "firmware"),
    full(from(kHomed, Hazard::kHome, "A homed arm homes a second time.",
              [](BoardBench& board) {
                board.act(with_code(kHome));
                board.about("homing a homed arm");
                const auto is_done = [](const Answer& answer) { return is_homed(answer); };
                board.expect_true(board.ask_until(idle(), is_done, 90s).has_value(),
                                  "all joints homed", "not within 90 s");
              })),
    variant("in-full", full(from(kHomed, Hazard::kHome, "The second run is like the first.",
                                 on<expect_second_run>))),

    must("parol6.home.held", "A home command held until homing ends starts the next run.",
         "firmware, vector B11", Profiles::kFirmware, "parol6.home.held-once"),
    full(from(kHomed, Hazard::kHome, "All joints are unhomed again 100 ms after the end of homing.",
              [](BoardBench& board) {
                board.expect(hold_home(board), "homed", 0x03);
                board.act(with_code(kEnable));
              })),

    should("parol6.home.held-once", "A home command held until homing ends has no further effect.",
           "document is silent; our choice", Profiles::kDocumented, "parol6.home.held"),
    full(from(kHomed, Hazard::kHome, "All joints stay homed and stand after the end of homing.",
              [](BoardBench& board) {
                board.expect(hold_home(board), "homed", 0xFF);
                expect_still(board, with_code(kHome), 200ms);
                board.act(with_code(kEnable));
              })),

    unobservable("in a clean run the conditions exclude each other, and what an interrupted one "
                 "shows depends "
                 "on the arm; recordings judge it",
                 must("parol6.home.conditions",
                      "The stages are conditions tried in a fixed order in every pass, and each "
                      "that holds acts.",
                      "firmware", Profiles::kFirmware)),

    unobservable("one pass is shorter than anything a host can time",
                 must("parol6.home.idle-after",
                      "The first idle pass after homing only drops the request; idle speeds count "
                      "from the next "
                      "pass on.",
                      "firmware", Profiles::kFirmware)),
};

}  // namespace

Chapter home_chapter() { return chapter("Homing, interrupted and repeated", kHomeClauses); }

}  // namespace armjig::parol6::conformance
