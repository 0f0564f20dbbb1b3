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

void enabled_at_start(BoardBench& board) { expect_jogs(board); }

void unhomed_at_start(BoardBench& board) { board.expect(board.ask(idle()), "homed", 0x03); }

void zero_at_start(BoardBench& board) {
  const auto answer = board.ask(idle());
  expect_reported(board, answer, {});
  for (std::size_t j = 0; j < kJointCount; ++j) board.expect(answer, position_field(j), 0);
}

void still_at_start(BoardBench& board) {
  const auto before = board.ask(with_code(0));
  board.pause(1s);
  expect_still(board, {before, board.ask(with_code(0))});
}

/// A jog that goes on for so long without another frame.
void expect_goes_on(BoardBench& board, const CommandFrame& frame, std::string_view what) {
  const auto before = run(board, frame, 0ms).after;
  board.pause(kSilence);
  board.about(fmt::format("250 ms after {}", what));
  expect_speed(board, {before, board.ask(frame)}, kJ5, kSpeed);
  board.act(idle());
}

void sticky(BoardBench& board) { expect_goes_on(board, a_jog(), "the only frame of a jog"); }

CommandFrame with_timeout(CommandFrame frame, int milliseconds) {
  frame.timeout = static_cast<std::uint8_t>(milliseconds);
  return frame;
}

void timeout_ignored(BoardBench& board) {
  expect_goes_on(board, with_timeout(a_jog(), 20), "a jog with a timeout of 20 ms");
}

void timeout_stops(BoardBench& board) {
  const auto frame = with_timeout(a_jog(), 100);
  const auto before = run(board, frame, 0ms).after;
  board.pause(kSilence);
  const auto after = board.ask(frame);
  board.about("250 ms after a jog with a timeout of 100 ms");
  board.expect_between(after, "position.j5", before.position[kJ5].value + 40,
                       before.position[kJ5].value + 60);
  board.act(idle());
  expect_goes_on(board, with_timeout(a_jog(), 0), "a jog without a timeout");
}

void timeout_reported(BoardBench& board) {
  board.expect(board.act(with_timeout(idle(), 100)), "timeout_error", 0);
  board.pause(kSilence);
  board.about("250 ms after a timeout of 100 ms");
  board.expect(board.ask(idle()), "timeout_error", 1);
  board.about("the answer after that");
  board.expect(board.ask(idle()), "timeout_error", 0);
}

void affected_joints_ignored(BoardBench& board) {
  for (const int bits : {0x00, 0x80, 0x04, 0xFF}) {
    auto frame = a_jog();
    frame.affected_joints = static_cast<std::uint8_t>(bits);
    board.about(fmt::format("a jog with affected_joints = {:02X}", bits));
    expect_speed(board, run(board, frame, 50ms), kJ5, kSpeed);
  }
  board.act(idle());
}

/// The frame stops a jog from full speed, and the board is usable afterwards.
void expect_stops(BoardBench& board, const CommandFrame& frame) {
  run(board, jog(kJ5, 5000), 20ms);
  board.act(frame);
  board.about(fmt::format("a jog, then code {}", static_cast<int>(frame.command)));
  expect_still(board, frame, kWhile);
  board.act(with_code(101));
  board.act(idle());
}

void disable_stops(BoardBench& board) { expect_stops(board, with_code(102)); }
void enable_stops(BoardBench& board) { expect_stops(board, with_code(101)); }
void clear_stops(BoardBench& board) { expect_stops(board, with_code(103)); }
void idle_stops(BoardBench& board) { expect_stops(board, idle()); }
void unknown_stops(BoardBench& board) {
  for (const int code : {0, 42, 200}) expect_stops(board, with_code(code));
}

void expect_speed_kept(BoardBench& board, const CommandFrame& frame) {
  board.act(a_jog());
  board.act(frame);
  board.about(fmt::format("a jog of j5 at 500, then code {}", static_cast<int>(frame.command)));
  board.expect(board.ask(frame), "speed.j5", kSpeed);
  board.act(with_code(101));
  board.act(idle());
}

void disable_keeps_speed(BoardBench& board) { expect_speed_kept(board, with_code(102)); }
void unknown_keeps_speed(BoardBench& board) { expect_speed_kept(board, with_code(42)); }

/// No jog moves the arm, until it is enabled.
void expect_no_jog(BoardBench& board, std::string_view what) {
  board.about(std::string{what});
  expect_still(board, a_jog(), kWhile);
  board.act(with_code(101));
}

void disabled_jog(BoardBench& board) {
  board.act(with_code(102));
  expect_no_jog(board, "a jog while disabled");
}

void disabled_jog_keeps_speed(BoardBench& board) {
  board.act(with_code(102));
  board.act(a_jog());
  board.about("a jog while disabled");
  board.expect(board.ask(a_jog()), "speed.j5", 0);
  board.act(with_code(101));
}

void disabled_go_to(BoardBench& board) {
  const auto rest = board.act(with_code(102));
  board.about("a go-to while disabled");
  expect_still(board, go_to(beside(rest, kJ5, 50)), kWhile);
  board.act(with_code(101));
}

void disabled_home(BoardBench& board) {
  board.act(with_code(102));
  const auto before = board.act(with_code(100));
  board.about("home while disabled");
  expect_still(board, with_code(100), kWhile);
  board.expect_same(board.ask(with_code(102)), "homed", before);
  board.act(with_code(101));
}

void disabled_home_forgotten(BoardBench& board) {
  board.act(with_code(102));
  board.act(with_code(100));
  board.act(with_code(101));
  board.about("home while disabled, then enable and idle");
  expect_still(board, idle(), kWhile);
}

void disabled_idle_speed(BoardBench& board) {
  board.act(with_code(102));
  const auto frame = with_speeds(255, {7, -8, 9, -10, 11, -12});
  board.act(frame);
  expect_reported(board, board.ask(with_code(102)), {7, -8, 9, -10, 11, -12});
  board.act(with_code(101));
}

void disabled_for_good(BoardBench& board) {
  board.act(with_code(102));
  for (const int code : {255, 0, 42, 103, 200, 255}) board.act(with_code(code));
  expect_no_jog(board, "a jog after disable and six other codes");
}

void enable(BoardBench& board) {
  board.act(with_code(102));
  board.act(with_code(101));
  board.about("a jog after disable and enable");
  expect_jogs(board);
}

void enable_alone(BoardBench& board) {
  board.act(a_jog());
  board.act(with_code(102));
  board.about("a jog, disable, enable");
  expect_still(board, with_code(101), kWhile);
  board.act(idle());
}

void clear_keeps_disabled(BoardBench& board) {
  board.act(with_code(102));
  board.act(with_code(103));
  expect_no_jog(board, "a jog after disable and clear error");
}

void clear_keeps_enabled(BoardBench& board) {
  board.act(with_code(103));
  board.about("a jog after clear error");
  expect_jogs(board);
}

/// Speeds and positions that would be seen at once.
CommandFrame tempting(const TelemetryFrame& rest, int code) {
  auto frame = with_speeds(code, {900, 900, 900, 900, 900, 900});
  for (std::size_t j = 0; j < kJointCount; ++j) {
    frame.position[j] = Steps{rest.position[j].value + 100};
  }
  return frame;
}

void idle_still(BoardBench& board) {
  expect_still(board, tempting(board.ask(idle()), 255), kWhile);
  board.act(idle());
}

void unknown_still(BoardBench& board) {
  constexpr int kMeant[] = {69, 100, 101, 102, 103, 123, 156, 255};
  const auto rest = board.ask(idle());
  for (int code = 0; code < 256; ++code) {
    if (std::ranges::find(kMeant, code) != std::end(kMeant)) continue;
    board.act(tempting(rest, code));
    board.about(fmt::format("code {} with speeds and positions", code));
    expect_still(board, {rest, board.ask(tempting(rest, code))});
  }
}

void teleport(BoardBench& board) {
  const auto rest = board.ask(idle());
  board.about("code 200 with other positions");
  board.act(tempting(rest, 200));
  expect_still(board, {rest, board.ask(idle())});
}

/// Whether frames of one write came to the board as one. A link may cut them, and USB does: its
/// next packet comes 50 us later, time enough for passes in between.
bool came_together(BoardBench& board, const std::vector<Answer>& answers) {
  constexpr int kTwentyMicroseconds = 14;
  if (answers.back().timing <= kTwentyMicroseconds) return true;
  board.leave_open("the link did not deliver two frames at once");
  return false;
}

void last_of_burst(BoardBench& board) {
  const auto answers = board.ask_together({a_jog(), with_code(42)});
  if (!came_together(board, answers)) return;
  board.pause(BoardBench::kPassTime);
  board.about("a jog and code 42 in one write");
  board.expect(board.ask(idle()), "speed.j5", 0);
  board.act(idle());
}

void last_of_burst_home(BoardBench& board) {
  const auto answers = board.ask_together({with_code(100), idle()});
  if (!came_together(board, answers)) return;
  board.pause(BoardBench::kPassTime);
  board.about("home and idle in one write");
  expect_still(board, idle(), kWhile);
}

void each_of_burst(BoardBench& board) {
  board.ask_together({a_jog(), with_code(42)});
  board.pause(BoardBench::kPassTime);
  board.about("a jog and code 42 in one write");
  board.expect(board.ask(with_code(42)), "speed.j5", kSpeed);
  board.act(idle());
}

constexpr Case kCases[] = {
    from(kFresh, Hazard::kMove, "parol6.command.enabled-at-start",
         "A board that was switched on jogs.", on<enabled_at_start>),
    from(kFresh, Hazard::kState, "parol6.command.unhomed-at-start",
         "A board that was switched on has no homed bit.", on<unhomed_at_start>),
    from(kFresh, Hazard::kState, "parol6.command.zero-at-start",
         "A board that was switched on reports zeros.", on<zero_at_start>),
    from(kFresh, Hazard::kState, "parol6.command.still-at-start",
         "A board that was switched on stands for a second.", on<still_at_start>),
    from(kEnabled, Hazard::kMove, "parol6.command.sticky", "One jog frame is enough for 250 ms.",
         on<sticky>),
    from(kEnabled, Hazard::kMove, "parol6.command.timeout-ignored",
         "A jog with a timeout of 20 ms goes on for 250 ms.", on<timeout_ignored>),
    from(kEnabled, Hazard::kMove, "parol6.command.timeout-stops",
         "A jog with a timeout of 100 ms makes the steps of 100 ms.", on<timeout_stops>),
    {.requirement = "parol6.command.timeout-reported",
     .rule = "A silence of 250 ms is an error after a timeout of 100 ms, once.",
     .run = on<timeout_reported>},
    from(kEnabled, Hazard::kMove, "parol6.command.affected-joints-ignored",
         "J5 jogs with four values of affected_joints.", on<affected_joints_ignored>),
    from(kEnabled, Hazard::kMove, "parol6.command.disable-stops",
         "A jog at 5000 steps/s ends with disable.", on<disable_stops>),
    from(kEnabled, Hazard::kMove, "parol6.command.disable-keeps-speed",
         "The speed of a jog is still shown after disable.", on<disable_keeps_speed>),
    from(kEnabled, Hazard::kMove, "parol6.command.disabled-jog",
         "No joint moves in a jog while disabled.", on<disabled_jog>),
    from(kEnabled, Hazard::kMove, "parol6.command.disabled-jog-keeps-speed",
         "A jog while disabled does not show.", on<disabled_jog_keeps_speed>),
    from(kHomed, Hazard::kMove, "parol6.command.disabled-go-to",
         "No joint moves in a go-to while disabled.", on<disabled_go_to>),
    from(kHomed, Hazard::kHome, "parol6.command.disabled-home", "Home does nothing while disabled.",
         on<disabled_home>),
    from(kEnabled, Hazard::kHome, "parol6.command.disabled-home-forgotten",
         "Home while disabled has no effect after enable.", on<disabled_home_forgotten>),
    from(kEnabled, Hazard::kState, "parol6.command.disabled-idle-speed",
         "Idle speeds show while disabled.", on<disabled_idle_speed>),
    from(kEnabled, Hazard::kMove, "parol6.command.disabled-for-good",
         "Six codes after disable do not enable.", on<disabled_for_good>),
    from(kEnabled, Hazard::kMove, "parol6.command.enable",
         "A board that was disabled jogs after enable.", on<enable>),
    from(kEnabled, Hazard::kMove, "parol6.command.enable-alone",
         "A jog that disable ended stays ended after enable.", on<enable_alone>),
    from(kEnabled, Hazard::kMove, "parol6.command.enable-stops",
         "A jog at 5000 steps/s ends with enable.", on<enable_stops>),
    from(kEnabled, Hazard::kMove, "parol6.command.clear-keeps-disabled",
         "No joint moves after disable and clear error.", on<clear_keeps_disabled>),
    from(kEnabled, Hazard::kMove, "parol6.command.clear-keeps-enabled",
         "A board jogs after clear error.", on<clear_keeps_enabled>),
    from(kEnabled, Hazard::kMove, "parol6.command.clear-stops",
         "A jog at 5000 steps/s ends with clear error.", on<clear_stops>),
    from(kEnabled, Hazard::kMove, "parol6.command.idle-stops",
         "A jog at 5000 steps/s ends with idle.", on<idle_stops>),
    from(kEnabled, Hazard::kMove, "parol6.command.idle-still",
         "Idle frames full of speeds and positions move nothing.", on<idle_still>),
    from(kEnabled, Hazard::kMove, "parol6.command.unknown",
         "A jog at 5000 steps/s ends with codes 0, 42 and 200.", on<unknown_stops>),
    from(kEnabled, Hazard::kMove, "parol6.command.unknown-keeps-speed",
         "The speed of a jog is still shown after code 42.", on<unknown_keeps_speed>),
    from(kEnabled, Hazard::kMove, "parol6.command.unknown-still",
         "248 codes with speeds and positions move nothing.", on<unknown_still>),
    from(kEnabled, Hazard::kMove, "parol6.command.teleport",
         "Code 200 with other positions changes none.", on<teleport>),
    from(kEnabled, Hazard::kMove, "parol6.loop.last-of-burst",
         "A jog directly before another code never begins.", on<last_of_burst>, "jog"),
    from(kEnabled, Hazard::kHome, "parol6.loop.last-of-burst",
         "A home directly before an idle frame never begins.", on<last_of_burst_home>, "home"),
    from(kEnabled, Hazard::kMove, "parol6.loop.each-of-burst",
         "A jog directly before another code sets its speed.", on<each_of_burst>),
};

}  // namespace

std::span<const Case> command_cases() noexcept { return kCases; }

}  // namespace armjig::parol6::conformance
