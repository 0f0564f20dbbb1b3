// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "conformance/parol6/board_bench.hpp"
#include "conformance/parol6/chapters.hpp"
#include "conformance/parol6/motion.hpp"

namespace armjig::parol6 {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kJ5 = 4;
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

void sticky(BoardBench& board) {
  const auto before = run(board, a_jog(), 0ms).after;
  board.pause(kSilence);
  board.about("250 ms after the only frame of a jog");
  expect_speed(board, {before, board.ask(a_jog())}, kJ5, kSpeed);
  board.act(idle());
}

CommandFrame with_timeout(CommandFrame frame, int milliseconds) {
  frame.timeout = static_cast<std::uint8_t>(milliseconds);
  return frame;
}

void timeout_ignored(BoardBench& board) {
  const auto frame = with_timeout(a_jog(), 20);
  const auto before = run(board, frame, 0ms).after;
  board.pause(kSilence);
  board.about("250 ms after a jog with a timeout of 20 ms");
  expect_speed(board, {before, board.ask(frame)}, kJ5, kSpeed);
  board.act(idle());
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
  const auto forever = run(board, with_timeout(a_jog(), 0), 0ms).after;
  board.pause(kSilence);
  board.about("250 ms after a jog without a timeout");
  expect_speed(board, {forever, board.ask(a_jog())}, kJ5, kSpeed);
  board.act(idle());
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

void disabled_jog(BoardBench& board) {
  board.act(with_code(102));
  board.about("a jog while disabled");
  expect_still(board, a_jog(), kWhile);
  board.act(with_code(101));
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
  auto frame = jog({7, -8, 9, -10, 11, -12});
  frame.command = Command::kIdle;
  board.act(frame);
  expect_reported(board, board.ask(with_code(102)), {7, -8, 9, -10, 11, -12});
  board.act(with_code(101));
}

void disabled_for_good(BoardBench& board) {
  board.act(with_code(102));
  for (const int code : {255, 0, 42, 103, 200, 255}) board.act(with_code(code));
  board.about("a jog after disable and six other codes");
  expect_still(board, a_jog(), kWhile);
  board.act(with_code(101));
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
  board.about("a jog after disable and clear error");
  expect_still(board, a_jog(), kWhile);
  board.act(with_code(101));
}

void clear_keeps_enabled(BoardBench& board) {
  board.act(with_code(103));
  board.about("a jog after clear error");
  expect_jogs(board);
}

/// Speeds and positions that would be seen at once.
CommandFrame tempting(const TelemetryFrame& rest, int code) {
  auto frame = jog({900, 900, 900, 900, 900, 900});
  for (std::size_t j = 0; j < kJointCount; ++j) {
    frame.position[j] = Steps{rest.position[j].value + 100};
  }
  frame.command = Command{static_cast<std::uint8_t>(code)};
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
    {.requirement = "parol6.command.enabled-at-start",
     .rule = "A board that was switched on jogs.",
     .run = on<enabled_at_start>,
     .hazard = Hazard::kMove,
     .start = kFresh},
    {.requirement = "parol6.command.unhomed-at-start",
     .rule = "A board that was switched on has no homed bit.",
     .run = on<unhomed_at_start>,
     .hazard = Hazard::kState,
     .start = kFresh},
    {.requirement = "parol6.command.zero-at-start",
     .rule = "A board that was switched on reports zeros.",
     .run = on<zero_at_start>,
     .hazard = Hazard::kState,
     .start = kFresh},
    {.requirement = "parol6.command.still-at-start",
     .rule = "A board that was switched on stands for a second.",
     .run = on<still_at_start>,
     .hazard = Hazard::kState,
     .start = kFresh},
    {.requirement = "parol6.command.sticky",
     .rule = "One jog frame is enough for 250 ms.",
     .run = on<sticky>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.timeout-ignored",
     .rule = "A jog with a timeout of 20 ms goes on for 250 ms.",
     .run = on<timeout_ignored>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.timeout-stops",
     .rule = "A jog with a timeout of 100 ms makes the steps of 100 ms.",
     .run = on<timeout_stops>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.timeout-reported",
     .rule = "A silence of 250 ms is an error after a timeout of 100 ms, once.",
     .run = on<timeout_reported>},
    {.requirement = "parol6.command.affected-joints-ignored",
     .rule = "J5 jogs with four values of affected_joints.",
     .run = on<affected_joints_ignored>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.disable-stops",
     .rule = "A jog at 5000 steps/s ends with disable.",
     .run = on<disable_stops>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.disable-keeps-speed",
     .rule = "The speed of a jog is still shown after disable.",
     .run = on<disable_keeps_speed>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.disabled-jog",
     .rule = "No joint moves in a jog while disabled.",
     .run = on<disabled_jog>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.disabled-jog-keeps-speed",
     .rule = "A jog while disabled does not show.",
     .run = on<disabled_jog_keeps_speed>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.disabled-go-to",
     .rule = "No joint moves in a go-to while disabled.",
     .run = on<disabled_go_to>,
     .hazard = Hazard::kMove,
     .start = kHomed},
    {.requirement = "parol6.command.disabled-home",
     .rule = "Home does nothing while disabled.",
     .run = on<disabled_home>,
     .hazard = Hazard::kHome,
     .start = kHomed},
    {.requirement = "parol6.command.disabled-home-forgotten",
     .rule = "Home while disabled has no effect after enable.",
     .run = on<disabled_home_forgotten>,
     .hazard = Hazard::kHome,
     .start = kEnabled},
    {.requirement = "parol6.command.disabled-idle-speed",
     .rule = "Idle speeds show while disabled.",
     .run = on<disabled_idle_speed>,
     .hazard = Hazard::kState,
     .start = kEnabled},
    {.requirement = "parol6.command.disabled-for-good",
     .rule = "Six codes after disable do not enable.",
     .run = on<disabled_for_good>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.enable",
     .rule = "A board that was disabled jogs after enable.",
     .run = on<enable>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.enable-alone",
     .rule = "A jog that disable ended stays ended after enable.",
     .run = on<enable_alone>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.enable-stops",
     .rule = "A jog at 5000 steps/s ends with enable.",
     .run = on<enable_stops>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.clear-keeps-disabled",
     .rule = "No joint moves after disable and clear error.",
     .run = on<clear_keeps_disabled>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.clear-keeps-enabled",
     .rule = "A board jogs after clear error.",
     .run = on<clear_keeps_enabled>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.clear-stops",
     .rule = "A jog at 5000 steps/s ends with clear error.",
     .run = on<clear_stops>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.idle-stops",
     .rule = "A jog at 5000 steps/s ends with idle.",
     .run = on<idle_stops>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.idle-still",
     .rule = "Idle frames full of speeds and positions move nothing.",
     .run = on<idle_still>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.unknown",
     .rule = "A jog at 5000 steps/s ends with codes 0, 42 and 200.",
     .run = on<unknown_stops>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.unknown-keeps-speed",
     .rule = "The speed of a jog is still shown after code 42.",
     .run = on<unknown_keeps_speed>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.unknown-still",
     .rule = "248 codes with speeds and positions move nothing.",
     .run = on<unknown_still>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.command.teleport",
     .rule = "Code 200 with other positions changes none.",
     .run = on<teleport>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.loop.last-of-burst",
     .variant = "jog",
     .rule = "A jog directly before another code never begins.",
     .run = on<last_of_burst>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
    {.requirement = "parol6.loop.last-of-burst",
     .variant = "home",
     .rule = "A home directly before an idle frame never begins.",
     .run = on<last_of_burst_home>,
     .hazard = Hazard::kHome,
     .start = kEnabled},
    {.requirement = "parol6.loop.each-of-burst",
     .rule = "A jog directly before another code sets its speed.",
     .run = on<each_of_burst>,
     .hazard = Hazard::kMove,
     .start = kEnabled},
};

}  // namespace

std::span<const Case> command_cases() noexcept { return kCases; }

}  // namespace armjig::parol6
