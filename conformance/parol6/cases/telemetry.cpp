// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

/// Codes that neither move anything nor change a state.
constexpr int kHarmlessCodes[] = {0, 1, 42, 99, 104, 122, 124, 155, 157, 200, 254, 255};

void layout(BoardBench& board) { board.expect_whole(); }

void check(BoardBench& board) { board.expect(board.ask(idle()), "check", kCheckBoard); }

void spare_homed(BoardBench& board) { board.expect_bits(board.ask(idle()), "homed", 0x03, 0x03); }

void spare_io(BoardBench& board) { board.expect_bits(board.ask(idle()), "io", 0x07, 0x07); }

void spare_errors(BoardBench& board) {
  const auto answer = board.ask(idle());
  board.expect_bits(answer, "temperature_error", 0x03, 0x03);
  board.expect_bits(answer, "position_error", 0x03, 0x03);
}

void temperature_error(BoardBench& board) {
  board.expect_bits(board.ask(idle()), "temperature_error", 0xFC, 0);
}

void no_position_error(BoardBench& board) {
  board.expect_bits(board.ask(idle()), "position_error", 0xFC, 0);
}

/// J5 of a homed arm, driven beyond its 6400 steps and back.
Answer beyond_range(BoardBench& board) {
  constexpr std::size_t kJoint = 4;
  const auto is_outside = [](const Answer& answer) { return answer.position[kJoint].value > 6420; };
  board.spoil();  // a guard would not let it go there; so it is an emulated one
  if (!board.ask_until(jog(kJoint, 7000), is_outside, 5s)) {
    board.fail("j5 to go beyond 6420 steps", "it does not");
  }
  const auto answer = board.act(idle());
  const auto is_inside = [](const Answer& back) { return back.position[kJoint].value < 6300; };
  (void)board.ask_until(jog(kJoint, -7000), is_inside, 5s);
  board.act(idle());
  return answer;
}

void no_position_error_outside(BoardBench& board) {
  board.expect_bits(beyond_range(board), "position_error", 0xFC, 0);
}

void position_error(BoardBench& board) {
  board.expect_bits(beyond_range(board), "position_error", 0xFC, flag(4));
  board.about("back in range, before clear error");
  board.expect_bits(board.ask(idle()), "position_error", 0xFC, flag(4));
  board.act(with_code(103));
  board.about("after clear error");
  board.expect_bits(board.ask(idle()), "position_error", 0xFC, 0);
}

void timeout_error(BoardBench& board) { board.expect(board.ask(idle()), "timeout_error", 100); }

constexpr GripperSetPoint kElsewhere{.speed = 77, .id = 5};

void gripper_id(BoardBench& board) {
  board.act(with_gripper(kElsewhere));
  board.expect(board.ask(with_gripper(kElsewhere)), "gripper.id", 0);
}

void gripper_id_echoed(BoardBench& board) {
  board.act(with_gripper(kElsewhere));
  board.expect(board.ask(with_gripper(kElsewhere)), "gripper.id", 5);
}

void gripper_speed(BoardBench& board) {
  board.act(with_gripper(kElsewhere));
  board.expect(board.ask(with_gripper(kElsewhere)), "gripper.speed", 1);
}

void gripper_speed_echoed(BoardBench& board) {
  board.act(with_gripper(kElsewhere));
  board.expect(board.ask(with_gripper(kElsewhere)), "gripper.speed", 77);
}

void plain_gripper_id(BoardBench& board) { board.expect(board.ask(idle()), "gripper.id", 0); }
void plain_gripper_speed(BoardBench& board) { board.expect(board.ask(idle()), "gripper.speed", 1); }
void gripper_object(BoardBench& board) { board.expect(board.ask(idle()), "gripper.object", 1); }

void gripper_object_decoded(BoardBench& board) {
  board.act(idle());
  const auto answer = board.ask(idle());
  const unsigned low = answer.gripper.status & gripper_status::kObjectLow ? 1 : 0;
  const unsigned high = answer.gripper.status & gripper_status::kObjectHigh ? 2 : 0;
  board.expect(answer, "gripper.object", low + high);
}

void echo(BoardBench& board) {
  for (const auto code : kHarmlessCodes) board.expect(board.ask(with_code(code)), "echo", code);
}

void echo_of_all(BoardBench& board) {
  auto frame = with_code(102);
  frame.position = board.act(frame).position;
  for (int code = 0; code < 256; ++code) {
    const bool enables = code == 101;
    const bool ignores_disable = code == 69;
    if (enables || ignores_disable) continue;
    frame.command = Command{static_cast<std::uint8_t>(code)};
    board.expect(board.ask(frame), "echo", code);
  }
  board.expect(board.act(with_code(101)), "echo", 101);
  board.act(idle());
}

constexpr double kTicksPerSecond = 703'125.0;
constexpr double kClockError = 0.02;  // the board runs from an RC oscillator: 1 %, and a margin

double ticks_in(Duration time) {
  return std::chrono::duration<double>(time).count() * kTicksPerSecond;
}

/// The board took each frame between when it was handed over and when its answer had come.
void expect_interval(BoardBench& board, const Answer& before, const Answer& after) {
  const auto least = ticks_in(after.asked - before.received) * (1 - kClockError) - 1;
  const auto most = ticks_in(after.received - before.asked) * (1 + kClockError) + 1;
  const auto above_least = static_cast<std::uint16_t>(after.timing - static_cast<int>(least));
  board.expect_true(above_least <= most - least + 1,
                    fmt::format("timing of {:.0f} to {:.0f} ticks, modulo 65536", least, most),
                    fmt::format("{} ticks", after.timing));
}

void expect_interval_after(BoardBench& board, Duration gap) {
  const auto before = board.ask(idle());
  board.pause(gap);
  expect_interval(board, before, board.ask(idle()));
}

void timing(BoardBench& board) {
  for (const auto gap : {1ms, 5ms, 10ms, 20ms, 60ms, 85ms}) expect_interval_after(board, gap);
}

void timing_wraps(BoardBench& board) {
  for (const auto gap : {100ms, 180ms, 190ms, 1000ms}) expect_interval_after(board, gap);
}

void timing_of_burst(BoardBench& board) {
  auto before = board.ask(idle());
  board.pause(10ms);
  const auto asked = board.now();
  for (auto answer : board.ask_together({idle(), idle(), idle()})) {
    answer.asked = asked;
    expect_interval(board, before, answer);
    before = answer;
  }
}

void timing_dropped(BoardBench& board) {
  const auto before = board.ask(idle());
  board.pause(10ms);
  auto dropped = encode(idle());
  dropped.back() = std::byte{3};
  board.send(dropped);
  board.pause(10ms);
  board.about("with a dropped frame in the middle");
  expect_interval(board, before, board.ask(idle()));
}

void old_motion(BoardBench& board) {
  const auto before = board.ask(idle());
  const auto first = board.act(jog(4, 500));
  board.about("the answer to the first frame of a jog");
  board.expect(first, "speed.j5", 0);
  board.expect_same(first, "position.j5", before);
  board.about("the answer to the second frame of a jog");
  board.expect(board.ask(jog(4, 500)), "speed.j5", 500);
  board.act(idle());
}

/// Slow enough that hardly a step is made.
Answer reported(BoardBench& board, const Speeds& speeds) {
  board.act(jog(speeds));
  const auto answer = board.ask(jog(speeds));
  board.act(idle());
  return answer;
}

void speed_own_joint(BoardBench& board) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Speeds speeds{};
    speeds[j] = 3;
    board.about(fmt::format("a jog of j{}", j + 1));
    expect_reported(board, reported(board, speeds), speeds);
  }
}

void speed_signed(BoardBench& board) {
  constexpr Speeds kSpeeds{-1, -2, -3, -4, -5, -6};
  expect_reported(board, reported(board, kSpeeds), kSpeeds);
}

void speed_big_endian(BoardBench& board) {
  constexpr Speeds kSpeeds{258, -259, 513, -514, 1027, 1290};
  expect_reported(board, reported(board, kSpeeds), kSpeeds);
}

void position_own_joint(BoardBench& board) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto stretch = run(board, jog(j, 900), 50ms);
    board.act(idle());
    for (std::size_t other = 0; other < kJointCount; ++other) {
      board.about(fmt::format("a jog of j{}", j + 1));
      if (other != j) board.expect_same(stretch.after, position_field(other), stretch.before);
    }
    board.expect_true(steps(stretch, j) > 0, fmt::format("j{} to count up", j + 1), "it does not");
  }
}

void position_signed(BoardBench& board) {
  for (const std::size_t j : {3U, 4U}) {
    const auto stretch = run(board, jog(j, -500), 100ms);
    board.act(idle());
    board.about(fmt::format("j{} backward from 0", j + 1));
    board.expect_between(stretch.after, position_field(j), -500, -20);
  }
}

void position_big_endian(BoardBench& board) {
  const auto answer = board.ask(idle());
  for (std::size_t j = 0; j < kJointCount; ++j) {
    board.expect(answer, position_field(j), kStandby[j].value);
  }
}

void idle_speed(BoardBench& board) {
  constexpr Speeds kSpeeds{1, -1, 255, -256, 40'000, -49'999};
  for (std::size_t turn = 0; turn < kJointCount; ++turn) {
    Speeds speeds{};
    for (std::size_t j = 0; j < kJointCount; ++j) speeds[j] = kSpeeds[(j + turn) % kJointCount];
    board.act(with_speeds(255, speeds));
    expect_reported(board, board.ask(with_speeds(255, speeds)), speeds);
  }
  board.act(idle());
}

void idle_reports_zero(BoardBench& board) {
  board.act(with_speeds(255, {1, -1, 255, -256, 40'000, -49'999}));
  expect_reported(board, board.ask(idle()), {});
}

void idle_speed_clamped(BoardBench& board) {
  board.act(with_speeds(255, {50'000, -50'000, 50'001, -50'001, 8'388'607, -8'388'608}));
  expect_reported(board, board.ask(idle()), {50'000, -50'000, 50'000, -50'000, 50'000, -50'000});
  board.act(idle());
}

constexpr Case kCases[] = {
    {.requirement = "parol6.telemetry.layout",
     .rule = "An answer is 60 bytes with start and end where they belong.",
     .run = on<layout>},
    {.requirement = "parol6.telemetry.check", .rule = "The check byte is D4.", .run = on<check>},
    {.requirement = "parol6.telemetry.spare-homed",
     .rule = "homed ends with 11.",
     .run = on<spare_homed>},
    {.requirement = "parol6.telemetry.spare-io", .rule = "io ends with 111.", .run = on<spare_io>},
    {.requirement = "parol6.telemetry.spare-errors",
     .rule = "Both error bytes end with 11.",
     .run = on<spare_errors>},
    {.requirement = "parol6.telemetry.temperature-error",
     .rule = "All temperature errors are 0.",
     .run = on<temperature_error>},
    {.requirement = "parol6.telemetry.no-position-error",
     .variant = "idle",
     .rule = "All position errors of an idle board are 0.",
     .run = on<no_position_error>},
    from(kHomed, Hazard::kMove, "parol6.telemetry.no-position-error",
         "J5 beyond its range is no error.", on<no_position_error_outside>, "outside"),
    from(kHomed, Hazard::kMove, "parol6.telemetry.position-error",
         "J5 beyond its range is an error until clear error.", on<position_error>),
    {.requirement = "parol6.telemetry.timeout-error",
     .rule = "The timeout error is 100.",
     .run = on<timeout_error>},
    {.requirement = "parol6.telemetry.gripper-id",
     .variant = "idle",
     .rule = "The gripper id is 0 while nothing is commanded.",
     .run = on<plain_gripper_id>},
    from(kListening, Hazard::kGrip, "parol6.telemetry.gripper-id",
         "The gripper id is 0 after a set-point for node 5.", on<gripper_id>, "commanded"),
    from(kListening, Hazard::kGrip, "parol6.telemetry.gripper-id-echoed",
         "The gripper id is 5 after a set-point for node 5.", on<gripper_id_echoed>),
    {.requirement = "parol6.telemetry.gripper-speed",
     .variant = "idle",
     .rule = "The gripper speed is 1 while nothing is commanded.",
     .run = on<plain_gripper_speed>},
    from(kListening, Hazard::kGrip, "parol6.telemetry.gripper-speed",
         "The gripper speed is 1 after a set-point with speed 77.", on<gripper_speed>, "commanded"),
    from(kListening, Hazard::kGrip, "parol6.telemetry.gripper-speed-echoed",
         "The gripper speed is 77 after a set-point with speed 77.", on<gripper_speed_echoed>),
    {.requirement = "parol6.telemetry.gripper-object",
     .rule = "The object byte is 1.",
     .run = on<gripper_object>},
    {.requirement = "parol6.telemetry.gripper-object-decoded",
     .rule = "The object byte agrees with the status.",
     .run = on<gripper_object_decoded>},
    {.requirement = "parol6.telemetry.echo",
     .rule = "Codes without effect are echoed.",
     .run = on<echo>},
    from(kHomed, Hazard::kHome, "parol6.telemetry.echo",
         "A disabled board echoes all codes but 69, which it would obey.", on<echo_of_all>, "all"),
    {.requirement = "parol6.telemetry.timing",
     .rule = "The timing field measures gaps up to 85 ms.",
     .run = on<timing>},
    {.requirement = "parol6.telemetry.timing",
     .variant = "burst",
     .rule = "Frames of a burst are hardly any time apart.",
     .run = on<timing_of_burst>},
    {.requirement = "parol6.telemetry.timing-wraps",
     .rule = "Gaps of 100 ms to 1 s are measured modulo 65536.",
     .run = on<timing_wraps>},
    {.requirement = "parol6.telemetry.timing-dropped",
     .rule = "A dropped frame does not begin a new interval.",
     .run = on<timing_dropped>},
    from(kEnabled, Hazard::kMove, "parol6.telemetry.old-motion",
         "The first answer to a jog shows rest, the second one its speed.", on<old_motion>),
    from(kEnabled, Hazard::kMove, "parol6.telemetry.speed-own-joint",
         "A jog of one joint shows in one speed field.", on<speed_own_joint>),
    from(kEnabled, Hazard::kMove, "parol6.telemetry.speed-signed",
         "Six slow jogs backward show as -1 to -6.", on<speed_signed>),
    from(kEnabled, Hazard::kMove, "parol6.telemetry.speed-big-endian",
         "Speeds whose bytes differ come back as they were.", on<speed_big_endian>),
    from(kEnabled, Hazard::kMove, "parol6.telemetry.position-own-joint",
         "A jog of one joint shows in one position field.", on<position_own_joint>),
    from(kHomed, Hazard::kMove, "parol6.telemetry.position-signed",
         "J4 and J5 below 0 have small negative positions.", on<position_signed>),
    from(kHomed, Hazard::kObserve, "parol6.telemetry.position-big-endian",
         "The six standby positions stand where they belong.", on<position_big_endian>),
    {.requirement = "parol6.telemetry.idle-speed",
     .rule = "Speeds of idle frames come back, joint by joint.",
     .run = on<idle_speed>},
    {.requirement = "parol6.telemetry.idle-reports-zero",
     .rule = "Speeds of idle frames do not come back.",
     .run = on<idle_reports_zero>},
    {.requirement = "parol6.telemetry.idle-speed-clamped",
     .rule = "Speeds beyond 50,000 come back as 50,000.",
     .run = on<idle_speed_clamped>},
};

}  // namespace

std::span<const Case> telemetry_cases() noexcept { return kCases; }

}  // namespace armjig::parol6::conformance
