// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr auto kGo = static_cast<std::uint8_t>(gripper_command::kActivate | gripper_command::kGoTo);
/// The whole way takes 0.56 s at speed byte 60, 1.6 s at 20.
constexpr Duration kWholeWay = 2500ms;

GripperSetPoint to(int position, int speed = 60, int current = 400) {
  return {.position = static_cast<std::int16_t>(position),
          .speed = static_cast<std::int16_t>(speed),
          .current = Milliamperes{static_cast<std::int16_t>(current)},
          .command = kGo};
}

GripperSetPoint in_mode(GripperSetPoint set_point, int mode) {
  set_point.mode = static_cast<std::uint8_t>(mode);
  return set_point;
}

bool is_calibrated(const Answer& answer) {
  return (answer.gripper.status & gripper_status::kCalibrated) != 0;
}

/// What telemetry shows before the gripper has said anything.
bool is_untold(const Answer& answer) {
  return answer.gripper.position == 0 && answer.gripper.current == Milliamperes{2} &&
         answer.gripper.status == 1;
}

/// The position, as the answer after the next one shows it: the gripper answers in between.
int position(BoardBench& board, const GripperSetPoint& set_point) {
  board.act(with_gripper(set_point));
  return board.ask(with_gripper(set_point)).gripper.position;
}

/// Calibrates the gripper, stands it at `place`. An active one cannot be taken for none. Leaves the
/// case open if there is no gripper.
void prepare(BoardBench& board, int place) {
  const GripperSetPoint active{.command = gripper_command::kActivate};
  board.act(with_gripper(active));
  const auto answer = board.act(with_gripper(active));
  if (is_untold(answer)) return board.leave_open("no gripper answers on the board's CAN");
  if (!is_calibrated(answer)) {
    board.act(with_gripper({.mode = 1}));
    board.about("a calibration");
    if (!board.ask_until(idle(), is_calibrated, 35s)) {
      board.fail("gripper.status with bit 01 within 35 s", "never");
    }
  }
  board.keep_asking(with_gripper(to(place)), kWholeWay);
}

void expect_at(BoardBench& board, const Answer& answer, int position) {
  board.expect_between(answer, "gripper.position", position - 1, position + 1);
}

void expect_stands(BoardBench& board, const GripperSetPoint& set_point) {
  const auto before = position(board, set_point);
  board.keep_asking(with_gripper(set_point), 300ms);
  board.expect(board.ask(with_gripper(set_point)), "gripper.position", before);
}

void expect_moves(BoardBench& board, const GripperSetPoint& set_point) {
  const auto before = position(board, set_point);
  const auto after = board.keep_asking(with_gripper(set_point), 300ms).gripper.position;
  board.expect_true(std::abs(after - before) > 3, "the gripper to move",
                    fmt::format("it goes from {} to {}", before, after));
}

void before_answer(BoardBench& board) {
  const auto answer = board.ask(idle());
  board.expect(answer, "gripper.position", 0);
  board.expect(answer, "gripper.current", 2);
  board.expect(answer, "gripper.status", 1);
}

void follows(BoardBench& board) {
  prepare(board, 0);
  for (const int place : {120, 30}) {
    board.about(fmt::format("a set-point of {}", place));
    expect_at(board, board.keep_asking(with_gripper(to(place)), kWholeWay), place);
  }
}

void latest(BoardBench& board) {
  prepare(board, 0);
  const auto far = to(150);
  board.about("a gripper that moved on in silence");
  board.keep_asking(with_gripper(far), 100ms);
  board.pause(kWholeWay);
  board.act(with_gripper(far));
  expect_at(board, board.ask(with_gripper(far)), 150);
}

void position_map(BoardBench& board) {
  prepare(board, 0);
  for (const int place : {255, 200, 128, 64, 1, 0}) {
    board.about(fmt::format("a set-point of {}", place));
    expect_at(board, board.keep_asking(with_gripper(to(place, 120)), 1s), place);
  }
}

void status_bits(BoardBench& board) {
  prepare(board, 40);
  constexpr std::uint8_t kBits = 0xC1;
  board.expect_bits(board.ask(with_gripper(to(40))), "gripper.status", kBits, 0xC1);
  auto inactive = to(40);
  inactive.command = gripper_command::kGoTo;
  board.act(with_gripper(inactive));
  board.expect_bits(board.ask(with_gripper(inactive)), "gripper.status", kBits, 0x41);
  inactive.command = gripper_command::kActivate;
  board.act(with_gripper(inactive));
  board.expect_bits(board.ask(with_gripper(inactive)), "gripper.status", kBits, 0x81);
}

void calibrates(BoardBench& board) {
  prepare(board, 100);
  board.act(with_gripper({.mode = 1}));
  board.act(idle());
  board.about("a calibration that has just begun");
  board.expect_bits(board.ask(idle()), "gripper.status", gripper_status::kCalibrated, 0);
  board.about("a calibration");
  board.expect_true(board.ask_until(idle(), is_calibrated, 35s).has_value(),
                    "gripper.status with bit 01 within 35 s", "never");
}

/// A drive that clear-error left idle on its way, with set-points that the board knows already.
GripperSetPoint idle_on_the_way(BoardBench& board) {
  prepare(board, 0);
  const auto far = to(250, 20);
  board.keep_asking(with_gripper(far), 200ms);
  board.act(with_gripper(in_mode(far, 2)));
  board.about("unchanged set-points after clear-error");
  expect_stands(board, far);
  return far;
}

void idle_until_changed(BoardBench& board) { idle_on_the_way(board); }

void change_of_position(BoardBench& board) {
  auto set_point = idle_on_the_way(board);
  set_point.position = 245;
  board.about("another position after clear-error");
  expect_moves(board, set_point);
}

void change_of_speed(BoardBench& board) {
  auto set_point = idle_on_the_way(board);
  set_point.speed = 21;
  board.about("another speed after clear-error");
  expect_moves(board, set_point);
}

void change_of_current(BoardBench& board) {
  auto set_point = idle_on_the_way(board);
  set_point.current = Milliamperes{401};
  board.about("another current after clear-error");
  expect_moves(board, set_point);
}

void change_of_command(BoardBench& board) {
  auto set_point = idle_on_the_way(board);
  set_point.command |= gripper_command::kReleaseDirection;
  board.about("another release direction after clear-error");
  expect_moves(board, set_point);
}

void other_modes(BoardBench& board) {
  auto set_point = idle_on_the_way(board);
  board.about("unchanged set-points in mode 7 after clear-error");
  expect_moves(board, in_mode(set_point, 7));
}

/// New set-points with clear-error, the same ones then in mode 0.
GripperSetPoint hidden_set_point(BoardBench& board) {
  auto set_point = idle_on_the_way(board);
  set_point.position = 200;
  board.act(with_gripper(in_mode(set_point, 2)));
  board.about("set-points that came with clear-error");
  return set_point;
}

void forgotten(BoardBench& board) { expect_stands(board, hidden_set_point(board)); }
void remembered(BoardBench& board) { expect_moves(board, hidden_set_point(board)); }

GripperSetPoint stopping(int place) {
  auto set_point = to(place);
  set_point.command |= gripper_command::kEstop;
  return set_point;
}

void stop(BoardBench& board) {
  prepare(board, 0);
  board.keep_asking(with_gripper(to(250, 20)), 200ms);
  board.act(with_gripper(stopping(250)));
  board.about("the stop flag on the way");
  expect_stands(board, stopping(250));
  board.expect_bits(board.ask(with_gripper(stopping(250))), "gripper.status",
                    gripper_status::kEstopError, gripper_status::kEstopError);
  board.act(with_gripper(in_mode(to(250), 0)));
  board.act(with_gripper(in_mode(to(250), 2)));
}

void clear_mode(BoardBench& board) {
  prepare(board, 0);
  board.act(with_gripper(stopping(100)));
  board.act(with_gripper(to(100)));
  board.about("the stop flag gone, without clear-error");
  board.expect_bits(board.ask(with_gripper(to(100))), "gripper.status", gripper_status::kEstopError,
                    gripper_status::kEstopError);
  board.act(with_gripper(in_mode(to(100), 2)));
  board.act(with_gripper(to(101)));
  board.about("after clear-error");
  board.expect_bits(board.ask(with_gripper(to(101))), "gripper.status", gripper_status::kEstopError,
                    0);
  expect_at(board, board.keep_asking(with_gripper(to(101)), kWholeWay), 101);
}

void clear_error(BoardBench& board) {
  prepare(board, 200);
  board.act(with_gripper({.mode = 1}));
  board.keep_asking(idle(), 200ms);
  board.act(with_gripper({.mode = 2}));
  board.about("clear-error in a calibration");
  expect_stands(board, {});
}

void position_low_byte(BoardBench& board) {
  prepare(board, 200);
  board.about("a set-point of 300");
  expect_at(board, board.keep_asking(with_gripper(to(300)), kWholeWay), 44);
}

void speed_low_byte(BoardBench& board) {
  prepare(board, 0);
  board.about("a speed of 256");
  const auto answer = board.keep_asking(with_gripper(to(250, 256)), 300ms);
  board.expect_between(answer, "gripper.position", 0, 3);
}

void speed_map(BoardBench& board) {
  for (const int speed : {10, 40}) {
    prepare(board, 0);
    const auto frame = with_gripper(to(255, speed));
    board.act(frame);
    const auto before = board.act(frame);
    const auto after = board.keep_asking(frame, 300ms);
    const auto steps_per_second = speed * 79'960 / 255 + 40;
    const auto rate = steps_per_second * 255.0 / 10'558;  // bytes/s
    const auto seconds = [](Duration time) { return std::chrono::duration<double>(time).count(); };
    // Each answer is as old as the frame before it at most.
    const auto shortest = seconds(after.asked - before.received) - 0.02;
    const auto longest = seconds(after.received - before.asked) + 0.02;
    board.about(fmt::format("{:.0f} ms at speed byte {}", longest * 1e3, speed));
    const auto way = after.gripper.position - before.gripper.position;
    board.expect_true(way >= shortest * rate * 0.95 - 2 && way <= longest * rate * 1.05 + 2,
                      fmt::format("a way of {:.0f} to {:.0f}", shortest * rate, longest * rate),
                      fmt::format("{}", way));
  }
}

void current_whole(BoardBench& board) {
  prepare(board, 0);
  board.about("a current of 256 mA, enough to move");
  expect_at(board, board.keep_asking(with_gripper(to(100, 60, 256)), kWholeWay), 100);
}

/// The gripper closes on something at 100.
Answer hold(BoardBench& board, int current) {
  prepare(board, 0);
  board.touch("between-fingers", 100);
  const auto answer = board.keep_asking(with_gripper(to(255, 60, current)), kWholeWay);
  board.spoil();
  board.about(fmt::format("something held with {} mA", current));
  return answer;
}

void current_signed(BoardBench& board) { board.expect(hold(board, 300), "gripper.current", -300); }
void current_any(BoardBench& board) { board.expect(hold(board, 2000), "gripper.current", -2000); }
void current_range(BoardBench& board) { board.expect(hold(board, 2000), "gripper.current", -1300); }

void object_code(BoardBench& board) {
  constexpr std::uint8_t kObject = 0x30;
  prepare(board, 0);
  board.act(with_gripper(to(250, 20)));
  board.keep_asking(with_gripper(to(250, 20)), 100ms);
  board.about("on the way");
  board.expect_bits(board.ask(with_gripper(to(250, 20))), "gripper.status", kObject, 0);
  board.about("at the position");
  board.expect_bits(board.keep_asking(with_gripper(to(250, 60)), kWholeWay), "gripper.status",
                    kObject, 0x30);
}

void object_held(BoardBench& board) {
  board.expect_bits(hold(board, 300), "gripper.status", 0x30, 0x20);
}

GripperSetPoint elsewhere(std::uint8_t id) {
  auto set_point = to(160);
  set_point.id = id;
  return set_point;
}

void whose_answer(BoardBench& board) {
  prepare(board, 60);
  board.about("a set-point for id 16");
  expect_at(board, board.keep_asking(with_gripper(elsewhere(16)), kWholeWay), 60);
}

void id_low_bits(BoardBench& board) {
  prepare(board, 60);
  board.keep_asking(with_gripper(elsewhere(16)), kWholeWay);
  board.about("a set-point for id 16, then polls of id 0");
  board.act(idle());
  board.act(idle());
  expect_at(board, board.ask(idle()), 160);
}

void other_node(BoardBench& board) {
  prepare(board, 60);
  board.about("a set-point for node 3");
  expect_at(board, board.keep_asking(with_gripper(elsewhere(3)), kWholeWay), 60);
  board.act(idle());
  board.act(idle());
  expect_at(board, board.ask(idle()), 60);
}

CommandFrame with_set_point(CommandFrame frame, const GripperSetPoint& set_point) {
  frame.gripper = set_point;
  return frame;
}

void expect_follows(BoardBench& board, const CommandFrame& frame, int place) {
  board.about(
      fmt::format("a set-point of {} with code {}", place, static_cast<int>(frame.command)));
  expect_at(board, board.keep_asking(with_set_point(frame, to(place, 200)), 600ms), place);
}

void while_disabled(BoardBench& board) {
  prepare(board, 0);
  board.act(with_set_point(with_code(102), to(0)));
  expect_follows(board, with_code(102), 120);
  expect_follows(board, idle(), 20);
  board.act(with_code(101));
}

void any_code(BoardBench& board) {
  prepare(board, 0);
  int place = 20;
  for (const int code : {0, 42, 101, 103, 200, 255}) {
    expect_follows(board, with_code(code), place);
    place += 30;
  }
}

void while_jogging(BoardBench& board) {
  prepare(board, 0);
  board.act(with_set_point(jog(4, 200), to(0)));
  const auto before = board.ask(with_set_point(jog(4, 200), to(0)));
  expect_follows(board, jog(4, 200), 120);
  const auto after = board.ask(with_set_point(jog(4, 200), to(120, 200)));
  board.about("a jog while the gripper is told to move");
  expect_speed(board, {before, after}, 4, 200);
  board.act(idle());
}

void while_going(BoardBench& board) {
  prepare(board, 0);
  const auto rest = board.ask(idle());
  const auto frame = go_to(beside(rest, 4, 80));
  expect_follows(board, frame, 120);
  board.about("a go-to while the gripper is told to move");
  board.expect(board.ask(with_set_point(frame, to(120, 200))), "position.j5",
               rest.position[4].value + 80);
  board.act(idle());
}

void while_homing(BoardBench& board) {
  prepare(board, 0);
  begin_homing(board, 20ms);
  expect_follows(board, idle(), 120);
  board.about("homing while the gripper is told to move");
  expect_speed(board, run(board, idle(), 100ms), 1, -2550);
  board.act(with_code(101));
}

void expect_asleep(BoardBench& board, std::uint8_t command) {
  prepare(board, 0);
  auto set_point = to(200);
  set_point.command = command;
  board.about(fmt::format("a gripper command of {:02X}", command));
  expect_stands(board, set_point);
}

void not_activated(BoardBench& board) { expect_asleep(board, gripper_command::kGoTo); }
void not_told_to_go(BoardBench& board) { expect_asleep(board, gripper_command::kActivate); }

void not_calibrated(BoardBench& board) {
  board.act(idle());
  board.act(idle());
  const auto answer = board.ask(idle());
  if (is_untold(answer)) return board.leave_open("no gripper answers on the board's CAN");
  if (is_calibrated(answer)) return board.leave_open("the gripper is calibrated at power-up");
  board.about("a set-point without a calibration");
  expect_stands(board, to(200));
}

constexpr Case grip(std::string_view requirement, std::string_view rule, void (*run)(Bench&),
                    Tier tier = Tier::kQuick, std::string_view variant = {}) {
  auto one = from(kEnabled, Hazard::kGrip, requirement, rule, run, variant);
  one.tier = tier;
  return one;
}

constexpr Case with(Case one, Start start) {
  one.start = start;
  return one;
}

constexpr auto kFull = Tier::kFull;

constexpr Case kCases[] = {
    with(grip("parol6.gripper.before-answer", "The first answer after power-up has 0, 2 and 01.",
              on<before_answer>),
         kFresh),
    with(grip("parol6.gripper.moves-when", "A gripper that is not calibrated stands.",
              on<not_calibrated>, Tier::kQuick, "calibrated"),
         kFresh),
    grip("parol6.gripper.moves-when", "A gripper that is not activated stands.", on<not_activated>,
         kFull, "activated"),
    grip("parol6.gripper.moves-when", "A gripper that is not told to go stands.",
         on<not_told_to_go>, kFull, "told"),
    grip("parol6.gripper.latest", "The second answer after a pause shows where it has gone.",
         on<latest>),
    grip("parol6.gripper.follows", "The gripper goes to 120 and to 30.", on<follows>),
    grip("parol6.gripper.position-map", "Six positions are reached.", on<position_map>, kFull),
    grip("parol6.gripper.status-bits", "Three bits of the status follow the command.",
         on<status_bits>, kFull),
    grip("parol6.gripper.calibrates", "The calibrated bit goes and comes.", on<calibrates>, kFull),
    grip("parol6.gripper.idle-until-changed", "Polls do not start an idle drive.",
         on<idle_until_changed>),
    grip("parol6.gripper.change-of-position", "Another position starts an idle drive.",
         on<change_of_position>, kFull),
    grip("parol6.gripper.change-of-speed", "Another speed starts an idle drive.",
         on<change_of_speed>, kFull),
    grip("parol6.gripper.change-of-current", "Another current starts an idle drive.",
         on<change_of_current>, kFull),
    grip("parol6.gripper.change-of-command", "Another command byte starts an idle drive.",
         on<change_of_command>, kFull),
    grip("parol6.gripper.clear-mode", "A stop error lasts until clear-error.", on<clear_mode>,
         kFull),
    grip("parol6.gripper.other-modes", "Mode 7 starts an idle drive.", on<other_modes>, kFull),
    grip("parol6.gripper.forgotten-set-point", "Set-points that came with clear-error are lost.",
         on<forgotten>, kFull),
    grip("parol6.gripper.remembered-set-point", "Set-points that came with clear-error are sent.",
         on<remembered>, kFull),
    grip("parol6.gripper.position-low-byte", "300 brings the gripper to 44.", on<position_low_byte>,
         kFull),
    grip("parol6.gripper.speed-low-byte", "256 hardly moves the gripper.", on<speed_low_byte>,
         kFull),
    grip("parol6.gripper.speed-map", "The gripper is as fast as speed bytes 10 and 40 say.",
         on<speed_map>, kFull),
    grip("parol6.gripper.current-whole", "256 mA move the gripper.", on<current_whole>, kFull),
    grip("parol6.gripper.current-signed", "Something held with 300 mA shows as -300.",
         on<current_signed>, kFull),
    grip("parol6.gripper.current-any", "Something held with 2000 mA shows as -2000.",
         on<current_any>, kFull),
    grip("parol6.gripper.current-range", "Something held with 2000 mA shows as -1300.",
         on<current_range>, kFull),
    grip("parol6.gripper.whose-answer", "Answers of node 0 are not shown for id 16.",
         on<whose_answer>, kFull),
    grip("parol6.gripper.id-low-bits", "A set-point for id 16 moves node 0.", on<id_low_bits>,
         kFull),
    grip("parol6.gripper.other-node", "A set-point for node 3 moves nothing here.", on<other_node>,
         kFull),
    grip("parol6.gripper.while-disabled", "A disabled board passes set-points on.",
         on<while_disabled>, kFull),
    grip("parol6.gripper.any-code", "Six codes bring set-points.", on<any_code>, kFull),
    grip("parol6.gripper.while-moving", "The gripper moves in a jog, which goes on.",
         on<while_jogging>, kFull, "jog"),
    with(grip("parol6.gripper.while-moving", "The gripper moves in a go-to, which arrives.",
              on<while_going>, kFull, "go-to"),
         kHomed),
    grip("parol6.gripper.while-moving", "The gripper moves during homing, which goes on.",
         on<while_homing>, kFull, "home"),
    grip("parol6.gripper.object-code", "The object code is 0 on the way and 3 at the position.",
         on<object_code>, kFull),
    grip("parol6.gripper.object-code", "Something between the fingers is object 1.",
         on<object_held>, kFull, "held"),
    grip("parol6.gripper.stop", "The stop flag stops the gripper and is an error.", on<stop>,
         kFull),
    grip("parol6.gripper.clear-error", "Clear-error stops a calibration.", on<clear_error>, kFull),
};

}  // namespace

std::span<const Case> gripper_cases() noexcept { return kCases; }

}  // namespace armjig::parol6::conformance
