// SPDX-License-Identifier: Apache-2.0
// Cases that mutants asked for: each finds faults that no other one does.
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr int kDemo = 69;
constexpr Speeds kSomeSpeeds{111, -222, 333, -444, 555, -666};

void prompt(BoardBench& board) {
  constexpr int kFrames = 50;
  int in_time = 0;
  for (int i = 0; i < kFrames; ++i) {
    const auto answer = board.ask(idle());
    if (answer.received - answer.asked < BoardBench::kFramePeriod) ++in_time;
    board.pause(std::max<Duration>(BoardBench::kFramePeriod - (board.now() - answer.asked), 0ms));
  }
  board.expect_true(in_time > kFrames / 2, "more than 25 of 50 answers within 10 ms",
                    fmt::format("{} were", in_time));
}

void all_whole(BoardBench& board) {
  for (int i = 0; i < 20 && !board.is_over(); ++i) board.expect_whole();
}

void outputs_stay(BoardBench& board) {
  auto frame = idle();
  frame.in_out = io_flag::kOut1 | io_flag::kOut2;
  board.ask(frame);
  board.about("the second frame with both outputs");
  board.expect_bits(board.ask(frame), "io", frame.in_out, frame.in_out);
  board.ask(idle());
}

void outputs_in_demo(BoardBench& board) {
  board.spoil();
  auto frame = with_code(kDemo);
  board.ask(frame);
  frame.in_out = io_flag::kOut1;
  board.about("code 69");
  board.expect_bits(board.ask(frame), "io", io_flag::kOut1, io_flag::kOut1);
}

void unknown_leaves_enabled(BoardBench& board) {
  board.act(with_code(42));
  board.about("a jog after code 42");
  expect_moved(board, run(board, jog(4, 1000), 50ms));
}

void disabled_keeps_speeds(BoardBench& board) {
  board.act(jog(4, 1000));
  const auto before = board.act(with_code(102));
  for (const int code : {42, 100, 102, 103, 123, 156}) {
    board.act(with_speeds(code, kSomeSpeeds));
    board.about(fmt::format("code {} with speeds, while disabled", code));
    const auto answer = board.ask(with_code(102));
    for (std::size_t j = 0; j < kJointCount; ++j) {
      board.expect_same(answer, speed_field(j), before);
    }
  }
  board.act(with_code(101));
}

/// From power-up, so that a board that never gets there fails this and not all that needs it.
void homes_at_all(BoardBench& board) {
  board.act(with_code(100));
  const auto is_done = [](const Answer& answer) { return is_homed(answer); };
  if (!board.ask_until(idle(), is_done, 90s)) board.fail("all joints homed", "not within 90 s");
}

void final_j5_j6(BoardBench& board) {
  const HomingRecord record{board.homing_log()};
  const auto before_end = record.with_bits(kFirstFourHomed);
  if (before_end.empty()) return board.leave_open("homing was too fast to be seen");
  board.about("the last answer before the end of homing");
  board.expect(before_end.back(), "position.j5", 8900);
  board.expect_between(before_end.back(), "position.j6", 0, 20);
}

void clear_in_homing_leaves_enabled(BoardBench& board) {
  begin_homing(board, 100ms);
  board.act(with_code(103));
  board.about("a jog after clear error in homing");
  expect_moved(board, run(board, jog(4, 1000), 50ms));
  board.act(with_code(101));
}

void go_to_in_homing_goes(BoardBench& board) {
  begin_homing(board, 100ms);
  board.act(with_code(42));
  const auto rest = board.ask(with_code(42));
  board.about("a go-to in homing");
  board.keep_asking(go_to(beside(rest, 4, 50)), 300ms);
  const auto answer = board.ask(go_to(beside(rest, 4, 50)));
  board.expect(answer, "position.j5", rest.position[4].value + 50);
  board.act(with_code(101));
}

void demo_in_homing(BoardBench& board) {
  board.spoil();
  board.act(with_code(100));
  board.keep_asking(idle(), 100ms);
  const auto stretch = run(board, with_code(kDemo), 500ms);
  board.about("j1, which homes downward, in 500 ms of code 69");
  board.expect_true(steps(stretch, 0) > 100, "more than 100 steps up",
                    fmt::format("{} steps", steps(stretch, 0)));
  board.about("a jog after it");
  expect_moved(board, run(board, jog(4, 1000), 50ms));
}

void demo_interrupted_while_disabled(BoardBench& board) {
  board.spoil();
  board.act(with_code(102));
  for (const int code : {42, 100, 102, 103, 123, 156}) {
    board.keep_asking(with_code(kDemo), 300ms);
    board.act(with_code(code));
    board.about(fmt::format("code {} in a demonstration while disabled", code));
    expect_still(board, with_code(code), 100ms);
  }
}

// The gripper.

constexpr GripperSetPoint to(int position, int speed) {
  return {.position = static_cast<std::int16_t>(position),
          .speed = static_cast<std::int16_t>(speed),
          .current = Milliamperes{400},
          .command = gripper_command::kActivate | gripper_command::kGoTo};
}

CommandFrame gripping(int code, const GripperSetPoint& set_point) {
  auto frame = with_gripper(set_point);
  frame.command = Command{static_cast<std::uint8_t>(code)};
  return frame;
}

/// Calibrates it and opens it. Leaves the case open if there is none.
void open_gripper(BoardBench& board) {
  const auto is_calibrated = [](const Answer& answer) {
    return (answer.gripper.status & gripper_status::kCalibrated) != 0;
  };
  const GripperSetPoint active{.command = gripper_command::kActivate};
  board.act(with_gripper(active));
  const auto answer = board.act(with_gripper(active));
  if (answer.gripper.current == Milliamperes{2} && answer.gripper.status == 1) {
    return board.leave_open("no gripper answers on the board's CAN");
  }
  if (!is_calibrated(answer)) {
    board.act(with_gripper({.mode = 1}));
    if (!board.ask_until(idle(), is_calibrated, 35s)) {
      return board.fail("a calibrated gripper within 35 s", "none");
    }
  }
  board.keep_asking(with_gripper(to(0, 60)), 2500ms);
}

void expect_closed_by(BoardBench& board, const CommandFrame& frame, Duration time) {
  const auto before = board.ask(with_gripper(to(0, 60))).gripper.position;
  board.keep_asking(frame, time);
  const auto after = board.ask(frame).gripper.position;
  board.expect_true(after - before > 100, "the gripper to close by more than 100",
                    fmt::format("it went from {} to {}", before, after));
}

void gripper_at_full_speed(BoardBench& board) {
  open_gripper(board);
  board.about("100 ms at speed byte 255");
  expect_closed_by(board, gripping(255, to(200, 255)), 150ms);
}

void gripper_while_home_is_held(BoardBench& board) {
  open_gripper(board);
  board.about("one second of code 100");
  expect_closed_by(board, gripping(100, to(200, 100)), 1s);
  board.act(with_code(101));
}

void gripper_in_demo(BoardBench& board) {
  board.spoil();
  open_gripper(board);
  board.about("one second of code 69");
  expect_closed_by(board, gripping(kDemo, to(200, 100)), 1s);
}

constexpr Case kCases[] = {
    {.requirement = "parol6.frame.prompt",
     .rule = "Of 50 answers at 100 Hz more than half come within 10 ms.",
     .run = on<prompt>},
    {.requirement = "parol6.telemetry.layout",
     .variant = "always",
     .rule = "Twenty answers are all whole.",
     .run = on<all_whole>},
    from(kListening, Hazard::kState, "parol6.telemetry.outputs",
         "Outputs stay on in a second frame that wants them.", on<outputs_stay>, "stay"),
    full(from(kFresh, Hazard::kMove, "parol6.io.outputs-moving",
              "OUT1 goes on in the demonstration.", on<outputs_in_demo>, "demo")),
    from(kEnabled, Hazard::kMove, "parol6.command.unknown", "J5 jogs after code 42.",
         on<unknown_leaves_enabled>, "leaves-enabled"),
    from(kEnabled, Hazard::kMove, "parol6.command.disabled-keeps-speeds",
         "Speeds that come with six codes while disabled do not show up.",
         on<disabled_keeps_speeds>),
    full(from(kEnabled, Hazard::kHome, "parol6.home.once", "A board homes within 90 s.",
              on<homes_at_all>, "at-all")),
    from(kHomed, Hazard::kHome, "parol6.home.final-j5-j6", "At the end J5 was at 8900 and J6 at 0.",
         on<final_j5_j6>),
    from(kHomed, Hazard::kHome, "parol6.home.ended-by-clear",
         "J5 jogs after clear error in homing.", on<clear_in_homing_leaves_enabled>,
         "leaves-enabled"),
    from(kHomed, Hazard::kHome, "parol6.home.ended-by-go-to", "A go-to in homing arrives.",
         on<go_to_in_homing_goes>, "goes"),
    from(kFresh, Hazard::kMove, "parol6.demo.pauses-homing",
         "J1 goes up with code 69 while it homes downward.", on<demo_in_homing>),
    from(kFresh, Hazard::kMove, "parol6.demo.disabled-interrupted",
         "Six codes in turn stop the demonstration of a disabled board.",
         on<demo_interrupted_while_disabled>),
    full(from(kEnabled, Hazard::kGrip, "parol6.gripper.speed-low-byte",
              "The gripper is fast at speed byte 255.", on<gripper_at_full_speed>, "full")),
    full(from(kHomed, Hazard::kHome, "parol6.gripper.any-code",
              "The gripper closes while home is held.", on<gripper_while_home_is_held>, "home")),
    full(from(kFresh, Hazard::kMove, "parol6.gripper.any-code",
              "The gripper closes in the demonstration.", on<gripper_in_demo>, "demo")),
};

}  // namespace

std::span<const Case> between_cases() noexcept { return kCases; }

}  // namespace armjig::parol6::conformance
