// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr int kSpeed = 500;

constexpr Duration kWhile = 100ms;

/// Half of what a supervisor waits before it stops an arm whose program is silent.
constexpr Duration kSilence = 250ms;

CommandFrame a_jog() { return jog(kJ5, kSpeed); }

void expect_jogs(BoardBench& board) {
  expect_speed(board, run(board, a_jog(), kWhile), kJ5, kSpeed);
  board.act(idle());
}

/// A jog that goes on for so long without another frame.
void expect_goes_on(BoardBench& board, const CommandFrame& frame, std::string_view what) {
  const auto before = run(board, frame, 0ms).after;
  board.pause(kSilence);
  board.about(fmt::format("250 ms after {}", what));
  expect_speed(board, {before, board.ask(frame)}, kJ5, kSpeed);
  board.act(idle());
}

CommandFrame with_timeout(CommandFrame frame, int milliseconds) {
  frame.timeout = static_cast<std::uint8_t>(milliseconds);
  return frame;
}

/// The frame stops a jog from full speed, and the board is usable afterwards.
void expect_stops(BoardBench& board, const CommandFrame& frame) {
  run(board, jog(kJ5, 5000), 20ms);
  board.act(frame);
  board.about(fmt::format("a jog, then code {}", static_cast<int>(frame.command)));
  expect_still(board, frame, kWhile);
  board.act(with_code(kEnable));
  board.act(idle());
}

void expect_speed_kept(BoardBench& board, const CommandFrame& frame) {
  board.act(a_jog());
  board.act(frame);
  board.about(fmt::format("a jog of j5 at 500, then code {}", static_cast<int>(frame.command)));
  board.expect(board.ask(frame), "speed.j5", kSpeed);
  board.act(with_code(kEnable));
  board.act(idle());
}

/// No jog moves the arm, until it is enabled.
void expect_no_jog(BoardBench& board, std::string_view what) {
  board.about(std::string{what});
  expect_still(board, a_jog(), kWhile);
  board.act(with_code(kEnable));
}

/// Speeds and positions that would be seen at once.
CommandFrame tempting(const TelemetryFrame& rest, int code) {
  auto frame = with_speeds(code, {900, 900, 900, 900, 900, 900});
  for (std::size_t j = 0; j < kJointCount; ++j) {
    frame.position[j] = Steps{rest.position[j].value + 100};
  }
  return frame;
}

/// Sends two frames in one write, until what the first one asks for has not begun or six times, and
/// answers what the board says next. None: they never came to it as one. A link may cut them, and
/// USB does: its next packet comes up to 50 us later, and whether a pass begins in between no host
/// can tell. A board that acts on both does so each time.
template <class HasBegun>
std::optional<Answer> ask_in_one_write(BoardBench& board, const CommandFrame& first,
                                       const CommandFrame& second, const CommandFrame& undo,
                                       HasBegun has_begun) {
  constexpr int kTries = 6;
  constexpr int kTwentyMicroseconds = 14;
  for (int i = 1; !board.is_over(); ++i) {
    const bool is_together =
        board.ask_together({first, second}).back().timing <= kTwentyMicroseconds;
    board.pause(BoardBench::kPassTime);
    const auto answer = board.ask(idle());
    if (is_together && (i >= kTries || !has_begun(answer))) return answer;
    if (i >= kTries) break;
    board.act(undo);
  }
  if (!board.is_over()) board.leave_open("the link did not deliver two frames at once");
  return std::nullopt;
}

constexpr Speeds kSomeSpeeds{111, -222, 333, -444, 555, -666};

constexpr Clause kCommandClauses[] = {
    must("parol6.command.enabled-at-start", "The board is enabled at power-up.", "firmware"),
    from(kFresh, Hazard::kMove, "A board that was switched on jogs.",
         [](BoardBench& board) { expect_jogs(board); }),

    must("parol6.command.unhomed-at-start", "No joint is homed at power-up.", "firmware"),
    from(kFresh, Hazard::kState, "A board that was switched on has no homed bit.",
         [](BoardBench& board) { board.expect(board.ask(idle()), "homed", 0x03); }),

    must("parol6.command.zero-at-start", "All counters and speeds are 0 at power-up.", "firmware"),
    from(kFresh, Hazard::kState, "A board that was switched on reports zeros.",
         [](BoardBench& board) {
           const auto answer = board.ask(idle());
           expect_reported(board, answer, {});
           for (std::size_t j = 0; j < kJointCount; ++j) board.expect(answer, position_field(j), 0);
         }),

    must("parol6.command.still-at-start",
         "A board that was switched on moves nothing until a frame says so.", "firmware"),
    from(kFresh, Hazard::kState, "A board that was switched on stands for a second.",
         [](BoardBench& board) {
           const auto before = board.ask(with_code(0));
           board.pause(1s);
           expect_still(board, {before, board.ask(with_code(0))});
         }),

    must("parol6.command.sticky", "A command acts in every pass until another frame is accepted.",
         "firmware: the last command byte is kept"),
    from(kEnabled, Hazard::kMove, "One jog frame is enough for 250 ms.",
         [](BoardBench& board) { expect_goes_on(board, a_jog(), "the only frame of a jog"); }),

    must("parol6.command.timeout-ignored",
         "The timeout byte of a frame changes nothing: a jog lasts for ever if no frame comes.",
         "firmware: stored and never looked at", Profiles::kFirmware,
         "parol6.command.timeout-stops"),
    from(kEnabled, Hazard::kMove, "A jog with a timeout of 20 ms goes on for 250 ms.",
         [](BoardBench& board) {
           expect_goes_on(board, with_timeout(a_jog(), 20), "a jog with a timeout of 20 ms");
         }),

    must(
        "parol6.command.timeout-stops",
        "After a longer silence than the timeout byte's milliseconds no joint steps until the next "
        "frame; 0 means no limit.",
        "document, timeout byte, made precise", Profiles::kDocumented,
        "parol6.command.timeout-ignored"),
    from(kEnabled, Hazard::kMove, "A jog with a timeout of 100 ms makes the steps of 100 ms.",
         [](BoardBench& board) {
           const auto frame = with_timeout(a_jog(), 100);
           const auto before = run(board, frame, 0ms).after;
           board.pause(kSilence);
           const auto after = board.ask(frame);
           board.about("250 ms after a jog with a timeout of 100 ms");
           board.expect_between(after, "position.j5", before.position[kJ5].value + 40,
                                before.position[kJ5].value + 60);
           board.act(idle());
           expect_goes_on(board, with_timeout(a_jog(), 0), "a jog without a timeout");
         }),

    must("parol6.command.timeout-reported",
         "The first answer after a silence that was too long has a timeout error of 1, all others "
         "0.",
         "document, timeout error, made precise", Profiles::kDocumented,
         "parol6.telemetry.timeout-error"),
    look("A silence of 250 ms is an error after a timeout of 100 ms, once.",
         [](BoardBench& board) {
           board.expect(board.act(with_timeout(idle(), 100)), "timeout_error", 0);
           board.pause(kSilence);
           board.about("250 ms after a timeout of 100 ms");
           board.expect(board.ask(idle()), "timeout_error", 1);
           board.about("the answer after that");
           board.expect(board.ask(idle()), "timeout_error", 0);
         }),

    must("parol6.command.affected-joints-ignored",
         "The affected_joints byte changes nothing: a jog drives all joints that have a speed.",
         "firmware: stored and never looked at"),
    from(kEnabled, Hazard::kMove, "J5 jogs with four values of affected_joints.",
         [](BoardBench& board) {
           for (const int bits : {0x00, 0x80, 0x04, 0xFF}) {
             auto frame = a_jog();
             frame.affected_joints = static_cast<std::uint8_t>(bits);
             board.about(fmt::format("a jog with affected_joints = {:02X}", bits));
             expect_speed(board, run(board, frame, 50ms), kJ5, kSpeed);
           }
           board.act(idle());
         }),

    must("parol6.command.disable-stops", "Disable stops all joints, from any speed.",
         "firmware: steppers get no more step calls"),
    from(kEnabled, Hazard::kMove, "A jog at 5000 steps/s ends with disable.",
         [](BoardBench& board) { expect_stops(board, with_code(kDisable)); }),

    must("parol6.command.disable-keeps-speed",
         "The speeds that telemetry reports stay what they were when the board is disabled.",
         "firmware, vector B5"),
    from(kEnabled, Hazard::kMove, "The speed of a jog is still shown after disable.",
         [](BoardBench& board) { expect_speed_kept(board, with_code(kDisable)); }),
    variant("enabled-again",
            from(kEnabled, Hazard::kMove, "It is still shown after disable and enable.",
                 [](BoardBench& board) {
                   board.act(a_jog());
                   board.act(with_code(kDisable));
                   board.act(with_code(kEnable));
                   board.about("a jog of j5 at 500, disable, enable");
                   board.expect(board.ask(with_code(kEnable)), "speed.j5", kSpeed);
                   board.act(idle());
                 })),

    must("parol6.command.disabled-jog", "A disabled board does not jog.", "firmware, vector B7"),
    from(kEnabled, Hazard::kMove, "No joint moves in a jog while disabled.",
         [](BoardBench& board) {
           board.act(with_code(kDisable));
           expect_no_jog(board, "a jog while disabled");
         }),

    must("parol6.command.disabled-go-to", "A disabled board follows no go-to.", "firmware"),
    from(kHomed, Hazard::kMove, "No joint moves in a go-to while disabled.",
         [](BoardBench& board) {
           const auto rest = board.act(with_code(kDisable));
           board.about("a go-to while disabled");
           expect_still(board, go_to(beside(rest, kJ5, 50)), kWhile);
           board.act(with_code(kEnable));
         }),

    must("parol6.command.disabled-home", "A disabled board does not home, and its homed bits stay.",
         "firmware"),
    from(kHomed, Hazard::kHome, "Home does nothing while disabled.",
         [](BoardBench& board) {
           board.act(with_code(kDisable));
           const auto before = board.act(with_code(kHome));
           board.about("home while disabled");
           expect_still(board, with_code(kHome), kWhile);
           board.expect_same(board.ask(with_code(kDisable)), "homed", before);
           board.act(with_code(kEnable));
         }),

    must("parol6.command.disabled-home-forgotten",
         "A home command that came while disabled is not made up for after enable.",
         "firmware: it is not even remembered"),
    from(kEnabled, Hazard::kHome, "Home while disabled has no effect after enable.",
         [](BoardBench& board) {
           board.act(with_code(kDisable));
           board.act(with_code(kHome));
           board.act(with_code(kEnable));
           board.about("home while disabled, then enable and idle");
           expect_still(board, idle(), kWhile);
         }),

    must("parol6.command.disabled-idle-speed",
         "An idle frame sets the reported speeds also while the board is disabled.",
         "firmware, vector B6", Profiles::kFirmware),
    from(kEnabled, Hazard::kState, "Idle speeds show while disabled.",
         [](BoardBench& board) {
           board.act(with_code(kDisable));
           const auto frame = with_speeds(255, {7, -8, 9, -10, 11, -12});
           board.act(frame);
           expect_reported(board, board.ask(with_code(kDisable)), {7, -8, 9, -10, 11, -12});
           board.act(with_code(kEnable));
         }),

    variant("after-home",
            from(kEnabled, Hazard::kHome, "Also after a home command, which is ignored.",
                 [](BoardBench& board) {
                   board.act(with_code(kDisable));
                   board.act(with_code(kHome));
                   board.act(with_speeds(255, {7, -8, 9, -10, 11, -12}));
                   expect_reported(board, board.ask(with_code(kDisable)), {7, -8, 9, -10, 11, -12});
                   board.act(with_code(kEnable));
                 })),

    must("parol6.command.disabled-for-good",
         "The board stays disabled, whatever comes, until it is enabled.", "firmware"),
    from(kEnabled, Hazard::kMove, "Six codes after disable do not enable.",
         [](BoardBench& board) {
           board.act(with_code(kDisable));
           for (const int code : {255, 0, 42, 103, 200, 255}) board.act(with_code(code));
           expect_no_jog(board, "a jog after disable and six other codes");
         }),

    must("parol6.command.disabled-jog-keeps-speed",
         "A jog that comes while disabled does not change the reported speeds.", "firmware"),
    from(kEnabled, Hazard::kMove, "A jog while disabled does not show.",
         [](BoardBench& board) {
           board.act(with_code(kDisable));
           board.act(a_jog());
           board.about("a jog while disabled");
           board.expect(board.ask(a_jog()), "speed.j5", 0);
           board.act(with_code(kEnable));
         }),

    must("parol6.command.enable", "Enable lets a disabled board move again.",
         "document, enable; firmware"),
    from(kEnabled, Hazard::kMove, "A board that was disabled jogs after enable.",
         [](BoardBench& board) {
           board.act(with_code(kDisable));
           board.act(with_code(kEnable));
           board.about("a jog after disable and enable");
           expect_jogs(board);
         }),

    must("parol6.command.enable-alone",
         "Enable moves nothing and does not resume what disable has stopped.", "firmware"),
    from(kEnabled, Hazard::kMove, "A jog that disable ended stays ended after enable.",
         [](BoardBench& board) {
           board.act(a_jog());
           board.act(with_code(kDisable));
           board.about("a jog, disable, enable");
           expect_still(board, with_code(kEnable), kWhile);
           board.act(idle());
         }),

    must("parol6.command.enable-stops", "Enable stops a jog, as any other code does.",
         "firmware: only jog steps in a jog"),
    from(kEnabled, Hazard::kMove, "A jog at 5000 steps/s ends with enable.",
         [](BoardBench& board) { expect_stops(board, with_code(kEnable)); }),

    must("parol6.command.clear-keeps-disabled", "Clear error does not enable a disabled board.",
         "firmware, vector B7"),
    from(kEnabled, Hazard::kMove, "No joint moves after disable and clear error.",
         [](BoardBench& board) {
           board.act(with_code(kDisable));
           board.act(with_code(kClearError));
           expect_no_jog(board, "a jog after disable and clear error");
         }),

    must("parol6.command.clear-keeps-enabled", "Clear error leaves an enabled board enabled.",
         "firmware"),
    from(kEnabled, Hazard::kMove, "A board jogs after clear error.",
         [](BoardBench& board) {
           board.act(with_code(kClearError));
           board.about("a jog after clear error");
           expect_jogs(board);
         }),

    must("parol6.command.clear-stops", "Clear error stops a jog.",
         "firmware: only jog steps in a jog"),
    from(kEnabled, Hazard::kMove, "A jog at 5000 steps/s ends with clear error.",
         [](BoardBench& board) { expect_stops(board, with_code(kClearError)); }),

    must("parol6.command.idle-stops", "An idle frame stops a jog at once.",
         "firmware: idle sets speeds and steps nothing"),
    from(kEnabled, Hazard::kMove, "A jog at 5000 steps/s ends with idle.",
         [](BoardBench& board) { expect_stops(board, idle()); }),

    must("parol6.command.idle-still",
         "An idle frame moves nothing, whatever speeds and positions it has.",
         "firmware: idle sets speeds and steps nothing"),
    from(kEnabled, Hazard::kMove, "Idle frames full of speeds and positions move nothing.",
         [](BoardBench& board) {
           expect_still(board, tempting(board.ask(idle()), 255), kWhile);
           board.act(idle());
         }),

    must("parol6.command.unknown", "A code without a meaning stops all stepping.",
         "firmware, vector B8"),
    from(kEnabled, Hazard::kMove, "A jog at 5000 steps/s ends with codes 0, 42 and 200.",
         [](BoardBench& board) {
           for (const int code : {0, 42, 200}) expect_stops(board, with_code(code));
         }),
    variant("leaves-enabled", from(kEnabled, Hazard::kMove, "J5 jogs after code 42.",
                                   [](BoardBench& board) {
                                     board.act(with_code(42));
                                     board.about("a jog after code 42");
                                     expect_moved(board, run(board, jog(4, 1000), 50ms));
                                   })),

    must("parol6.command.unknown-keeps-speed",
         "A code without a meaning leaves the reported speeds as they were.",
         "firmware, vector B8"),
    from(kEnabled, Hazard::kMove,
         "The speed of a jog is still shown after codes with other speeds.",
         [](BoardBench& board) {
           for (const int code : {0, 42, 200}) {
             expect_speed_kept(board, with_speeds(code, kSomeSpeeds));
           }
         }),

    must("parol6.command.unknown-still",
         "No code without a meaning moves anything, whatever speeds and positions come with it.",
         "firmware"),
    from(kEnabled, Hazard::kMove, "248 codes with speeds and positions move nothing.",
         [](BoardBench& board) {
           constexpr int kMeant[] = {69, 100, 101, 102, 103, 123, 156, 255};
           const auto rest = board.ask(idle());
           for (int code = 0; code < 256; ++code) {
             if (std::ranges::find(kMeant, code) != std::end(kMeant)) continue;
             board.act(tempting(rest, code));
             board.about(fmt::format("code {} with speeds and positions", code));
             expect_still(board, {rest, board.ask(tempting(rest, code))});
           }
         }),

    must("parol6.command.teleport",
         "Code 200, which a simulator takes for a jump to a position, changes no counter.",
         "firmware: a code without a meaning"),
    from(kEnabled, Hazard::kMove, "Code 200 with other positions changes none.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle());
           board.about("code 200 with other positions");
           board.act(tempting(rest, 200));
           expect_still(board, {rest, board.ask(idle())});
         }),

    must("parol6.loop.last-of-burst",
         "Of frames answered in one pass only the last one's command is acted on.",
         "firmware, vector B10", Profiles::kFirmware, "parol6.loop.each-of-burst"),
    variant("jog", from(kEnabled, Hazard::kMove, "A jog directly before another code never begins.",
                        [](BoardBench& board) {
                          const auto answer = ask_in_one_write(
                              board, a_jog(), with_code(42), idle(),
                              [](const Answer& said) { return said.speed[kJ5].value != 0; });
                          if (!answer) return;
                          board.about("a jog and code 42 in one write");
                          board.expect(*answer, "speed.j5", 0);
                          board.act(idle());
                        })),
    variant("home",
            from(kEnabled, Hazard::kHome, "A home directly before an idle frame never begins.",
                 [](BoardBench& board) {
                   const auto answer = ask_in_one_write(
                       board, with_code(kHome), idle(), with_code(kClearError),
                       [](const Answer& said) { return said.speed[0].value != 0; });
                   if (!answer) return;
                   board.about("home and idle in one write");
                   expect_still(board, idle(), kWhile);
                 })),

    should("parol6.loop.each-of-burst", "Each frame of a burst is acted on for at least one pass.",
           "document is silent; our choice", Profiles::kDocumented, "parol6.loop.last-of-burst"),
    from(kEnabled, Hazard::kMove, "A jog directly before another code sets its speed.",
         [](BoardBench& board) {
           board.ask_together({a_jog(), with_code(42)});
           board.pause(BoardBench::kPassTime);
           board.about("a jog and code 42 in one write");
           board.expect(board.ask(with_code(42)), "speed.j5", kSpeed);
           board.act(idle());
         }),

    unobservable("a pass is shorter than anything a host can time; what follows from the order has "
                 "requirements of its own (parol6.telemetry.old-motion, parol6.loop.last-of-burst)",
                 must("parol6.loop.order",
                      "A pass acts first, then copies what telemetry says, then takes at most one "
                      "CAN frame, then "
                      "reads and answers everything that has come.",
                      "firmware", Profiles::kFirmware)),

    must("parol6.command.disabled-keeps-speeds",
         "While disabled, codes other than idle leave the reported speeds as they are, whatever "
         "speeds "
         "come with them.",
         "firmware"),
    from(kEnabled, Hazard::kMove, "Speeds that come with six codes while disabled do not show up.",
         [](BoardBench& board) {
           board.act(jog(4, 1000));
           const auto before = board.act(with_code(kDisable));
           for (const int code : {42, 100, 102, 103, 123, 156}) {
             board.act(with_speeds(code, kSomeSpeeds));
             board.about(fmt::format("code {} with speeds, while disabled", code));
             const auto answer = board.ask(with_code(kDisable));
             for (std::size_t j = 0; j < kJointCount; ++j) {
               board.expect_same(answer, speed_field(j), before);
             }
           }
           board.act(with_code(kEnable));
         }),
};

}  // namespace

Chapter command_chapter() { return chapter("Commands", kCommandClauses); }

}  // namespace armjig::parol6::conformance
