// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr auto kHidden = "the CAN between board and gripper cannot be seen on the serial link";

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
    board.act(with_gripper({.mode = gripper_mode::kCalibrate}));
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

/// New set-points with clear-error, the same ones then in mode 0.
GripperSetPoint hidden_set_point(BoardBench& board) {
  auto set_point = idle_on_the_way(board);
  set_point.position = 200;
  board.act(with_gripper(in_mode(set_point, 2)));
  board.about("set-points that came with clear-error");
  return set_point;
}

GripperSetPoint stopping(int place) {
  auto set_point = to(place);
  set_point.command |= gripper_command::kEstop;
  return set_point;
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

GripperSetPoint elsewhere(std::uint8_t id) {
  auto set_point = to(160);
  set_point.id = id;
  return set_point;
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

void expect_asleep(BoardBench& board, std::uint8_t command) {
  prepare(board, 0);
  auto set_point = to(200);
  set_point.command = command;
  board.about(fmt::format("a gripper command of {:02X}", command));
  expect_stands(board, set_point);
}

/// Ends a calibration when it is on its way to the closed end, and begins another one.
void calibrate_twice(BoardBench& board) {
  constexpr int kClosing = 120;
  const GripperSetPoint calibrate{.mode = gripper_mode::kCalibrate};
  prepare(board, 60);
  board.act(with_gripper(calibrate));
  const auto closes = [](const Answer& answer) { return answer.gripper.position > kClosing; };
  board.about("a calibration that closes");
  if (!board.ask_until(idle(), closes, 35s)) {
    board.fail(fmt::format("gripper.position above {} within 35 s", kClosing), "never");
  }
  board.act(with_gripper({.mode = gripper_mode::kClearError}));
  board.act(with_gripper(calibrate));
}

constexpr Case grip(std::string_view rule, CaseBody run, Tier tier = Tier::kQuick) {
  auto one = from(kEnabled, Hazard::kGrip, rule, run);
  one.tier = tier;
  return one;
}

constexpr Case with(Case one, Start start) {
  one.start = start;
  return one;
}

constexpr auto kFull = Tier::kFull;

CommandFrame gripping(Command code, const GripperSetPoint& set_point) {
  auto frame = with_gripper(set_point);
  frame.command = code;
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
    board.act(with_gripper({.mode = gripper_mode::kCalibrate}));
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

constexpr Clause kGripperClauses[] = {
    must("parol6.gripper.before-answer",
         "Before the gripper's first answer telemetry has gripper position 0, current 2 mA, status "
         "01.",
         "firmware"),
    with(grip("The first answer after power-up has 0, 2 and 01.",
              [](BoardBench& board) {
                const auto answer = board.ask(idle());
                board.expect(answer, "gripper.position", 0);
                board.expect(answer, "gripper.current", 2);
                board.expect(answer, "gripper.status", 1);
              }),
         kFresh),

    must("parol6.gripper.latest", "Telemetry shows what the gripper answered to the frame before.",
         "firmware: every frame asks the gripper"),
    grip("The second answer after a pause shows where it has gone.",
         [](BoardBench& board) {
           prepare(board, 0);
           const auto far = to(150);
           board.about("a gripper that moved on in silence");
           board.keep_asking(with_gripper(far), 100ms);
           board.pause(kWholeWay);
           board.act(with_gripper(far));
           expect_at(board, board.ask(with_gripper(far)), 150);
         }),

    must("parol6.gripper.follows",
         "Set-points in mode 0 move a calibrated gripper to their position, and telemetry shows it "
         "there.",
         "document, gripper; firmware; gripper"),
    grip("The gripper goes to 120 and to 30.",
         [](BoardBench& board) {
           prepare(board, 0);
           for (const int place : {120, 30}) {
             board.about(fmt::format("a set-point of {}", place));
             expect_at(board, board.keep_asking(with_gripper(to(place)), kWholeWay), place);
           }
         }),

    must("parol6.gripper.position-map",
         "Position bytes 0 to 255 map linearly to the way from open to closed, and the answer maps "
         "back.",
         "gripper"),
    grip(
        "Six positions are reached.",
        [](BoardBench& board) {
          prepare(board, 0);
          for (const int place : {255, 200, 128, 64, 1, 0}) {
            board.about(fmt::format("a set-point of {}", place));
            expect_at(board, board.keep_asking(with_gripper(to(place, 120)), 1s), place);
          }
        },
        kFull),

    must("parol6.gripper.status-bits",
         "The status shows activated, go-to and calibrated in bits 80, 40 and 01.",
         "gripper, passed through by the firmware"),
    grip(
        "Three bits of the status follow the command.",
        [](BoardBench& board) {
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
        },
        kFull),

    must("parol6.gripper.calibrates",
         "Mode 1 calibrates the gripper, which the status shows at the end.",
         "document, gripper; firmware; gripper"),
    grip(
        "The calibrated bit goes and comes.",
        [](BoardBench& board) {
          prepare(board, 100);
          board.act(with_gripper({.mode = gripper_mode::kCalibrate}));
          board.act(idle());
          board.about("a calibration that has just begun");
          board.expect_bits(board.ask(idle()), "gripper.status", gripper_status::kCalibrated, 0);
          board.about("a calibration");
          board.expect_true(board.ask_until(idle(), is_calibrated, 35s).has_value(),
                            "gripper.status with bit 01 within 35 s", "never");
        },
        kFull),

    must("parol6.gripper.calibrates-anew",
         "A calibration opens the gripper first, also after one that was ended when it closed.",
         "gripper"),
    grip(
        "The second one comes to the open end, and is done.",
        [](BoardBench& board) {
          calibrate_twice(board);
          const auto is_open = [](const Answer& answer) { return answer.gripper.position <= 2; };
          board.about("a calibration after one that was ended");
          board.expect_true(board.ask_until(idle(), is_open, kWholeWay).has_value(),
                            "gripper.position of 2 at most within 2.5 s", "never");
          board.expect_true(board.ask_until(idle(), is_calibrated, 35s).has_value(),
                            "gripper.status with bit 01 within 35 s", "never");
        },
        kFull),

    must("parol6.gripper.idle-until-changed",
         "After calibration or clear-error the gripper stands until a set-point changes.",
         "gripper and firmware: unchanged set-points are only polls"),
    grip("Polls do not start an idle drive.", [](BoardBench& board) { idle_on_the_way(board); }),

    must("parol6.gripper.change-of-position", "A changed gripper position sends the set-points.",
         "firmware"),
    grip(
        "Another position starts an idle drive.",
        [](BoardBench& board) {
          auto set_point = idle_on_the_way(board);
          set_point.position = 245;
          board.about("another position after clear-error");
          expect_moves(board, set_point);
        },
        kFull),

    must("parol6.gripper.change-of-speed", "A changed gripper speed sends the set-points.",
         "firmware"),
    grip(
        "Another speed starts an idle drive.",
        [](BoardBench& board) {
          auto set_point = idle_on_the_way(board);
          set_point.speed = 21;
          board.about("another speed after clear-error");
          expect_moves(board, set_point);
        },
        kFull),

    must("parol6.gripper.change-of-current", "A changed gripper current sends the set-points.",
         "firmware"),
    grip(
        "Another current starts an idle drive.",
        [](BoardBench& board) {
          auto set_point = idle_on_the_way(board);
          set_point.current = Milliamperes{401};
          board.about("another current after clear-error");
          expect_moves(board, set_point);
        },
        kFull),

    must("parol6.gripper.change-of-command", "A changed gripper command byte sends the set-points.",
         "firmware"),
    grip(
        "Another command byte starts an idle drive.",
        [](BoardBench& board) {
          auto set_point = idle_on_the_way(board);
          set_point.command |= gripper_command::kReleaseDirection;
          board.about("another release direction after clear-error");
          expect_moves(board, set_point);
        },
        kFull),

    must("parol6.gripper.change-of-id",
         "A changed gripper id sends the set-points, which another node had before.", "firmware"),
    grip(
        "What went to node 3 moves node 0 when that is named.",
        [](BoardBench& board) {
          prepare(board, 60);
          board.act(with_gripper(elsewhere(3)));
          board.about("the set-points of node 3, for node 0");
          expect_at(board, board.keep_asking(with_gripper(elsewhere(0)), kWholeWay), 160);
        },
        kFull),

    must("parol6.gripper.clear-mode", "Mode 2 takes the stop error of the gripper back.",
         "document, gripper; firmware; gripper"),
    grip(
        "A stop error lasts until clear-error.",
        [](BoardBench& board) {
          prepare(board, 0);
          board.act(with_gripper(stopping(100)));
          board.act(with_gripper(to(100)));
          board.about("the stop flag gone, without clear-error");
          board.expect_bits(board.ask(with_gripper(to(100))), "gripper.status",
                            gripper_status::kEstopError, gripper_status::kEstopError);
          board.act(with_gripper(in_mode(to(100), 2)));
          board.act(with_gripper(to(101)));
          board.about("after clear-error");
          board.expect_bits(board.ask(with_gripper(to(101))), "gripper.status",
                            gripper_status::kEstopError, 0);
          expect_at(board, board.keep_asking(with_gripper(to(101)), kWholeWay), 101);
        },
        kFull),

    must("parol6.gripper.other-modes",
         "Modes from 3 on send the set-points with every frame, also unchanged ones.", "firmware"),
    grip(
        "Mode 7 starts an idle drive.",
        [](BoardBench& board) {
          auto set_point = idle_on_the_way(board);
          board.about("unchanged set-points in mode 7 after clear-error");
          expect_moves(board, in_mode(set_point, 7));
        },
        kFull),

    must("parol6.gripper.forgotten-set-point",
         "Set-points that arrive together with a calibration or a clear-error count as sent "
         "although "
         "they were not.",
         "firmware, vector G3", Profiles::kFirmware, "parol6.gripper.remembered-set-point"),
    grip(
        "Set-points that came with clear-error are lost.",
        [](BoardBench& board) { expect_stands(board, hidden_set_point(board)); }, kFull),

    should("parol6.gripper.remembered-set-point",
           "Set-points that arrive together with a calibration or a clear-error are sent with the "
           "next "
           "frame in mode 0.",
           "document is silent; our choice", Profiles::kDocumented,
           "parol6.gripper.forgotten-set-point"),
    grip(
        "Set-points that came with clear-error are sent.",
        [](BoardBench& board) { expect_moves(board, hidden_set_point(board)); }, kFull),

    must("parol6.gripper.position-low-byte",
         "The low byte of the gripper position goes to the gripper: 300 is 44.", "firmware"),
    grip(
        "300 brings the gripper to 44.",
        [](BoardBench& board) {
          prepare(board, 200);
          board.about("a set-point of 300");
          expect_at(board, board.keep_asking(with_gripper(to(300)), kWholeWay), 44);
        },
        kFull),

    must("parol6.gripper.speed-low-byte",
         "The low byte of the gripper speed goes to the gripper: 256 is 0.", "firmware"),
    grip(
        "256 hardly moves the gripper.",
        [](BoardBench& board) {
          prepare(board, 0);
          board.about("a speed of 256");
          const auto answer = board.keep_asking(with_gripper(to(250, 256)), 300ms);
          board.expect_between(answer, "gripper.position", 0, 3);
        },
        kFull),
    variant("full", full(from(kEnabled, Hazard::kGrip, "The gripper is fast at speed byte 255.",
                              [](BoardBench& board) {
                                open_gripper(board);
                                board.about("100 ms at speed byte 255");
                                expect_closed_by(board, gripping(kIdle, to(200, 255)), 150ms);
                              }))),

    must("parol6.gripper.speed-map",
         "Speed byte b means b * 79960 / 255 + 40 counts/s, in integers.", "gripper"),
    grip(
        "The gripper is as fast as speed bytes 10 and 40 say.",
        [](BoardBench& board) {
          for (const int speed : {10, 40}) {
            prepare(board, 0);
            const auto frame = with_gripper(to(255, speed));
            board.act(frame);
            const auto before = board.act(frame);
            const auto after = board.keep_asking(frame, 300ms);
            const auto steps_per_second = speed * 79'960 / 255 + 40;
            const auto rate = steps_per_second * 255.0 / 10'558;  // bytes/s
            const auto seconds = [](Duration time) {
              return std::chrono::duration<double>(time).count();
            };
            // Each answer is as old as the frame before it at most.
            const auto shortest = seconds(after.asked - before.received) - 0.02;
            const auto longest = seconds(after.received - before.asked) + 0.02;
            board.about(fmt::format("{:.0f} ms at speed byte {}", longest * 1e3, speed));
            const auto way = after.gripper.position - before.gripper.position;
            board.expect_true(
                way >= shortest * rate * 0.95 - 2 && way <= longest * rate * 1.05 + 2,
                fmt::format("a way of {:.0f} to {:.0f}", shortest * rate, longest * rate),
                fmt::format("{}", way));
          }
        },
        kFull),

    must("parol6.gripper.current-whole", "Both bytes of the gripper current go to the gripper.",
         "firmware"),
    grip(
        "256 mA move the gripper.",
        [](BoardBench& board) {
          prepare(board, 0);
          board.about("a current of 256 mA, enough to move");
          expect_at(board, board.keep_asking(with_gripper(to(100, 60, 256)), kWholeWay), 100);
        },
        kFull),

    must("parol6.gripper.current-signed",
         "The gripper's current is shown as it was answered, signed: negative while it closes.",
         "firmware; gripper"),
    grip(
        "Something held with 300 mA shows as -300.",
        [](BoardBench& board) { board.expect(hold(board, 300), "gripper.current", -300); }, kFull),

    must("parol6.gripper.current-free",
         "While the fingers move and meet nothing, the gripper's current is shown with the sign of "
         "their motion, and no more than was allowed.",
         "firmware; gripper"),
    grip(
        "Closing and opening with 1000 mA.",
        [](BoardBench& board) {
          prepare(board, 0);
          board.about("fingers that close freely");
          const auto closing = board.keep_asking(with_gripper(to(250, 20, 1000)), 400ms);
          board.expect_between(closing, "gripper.current", -1000, -1);
          board.keep_asking(with_gripper(to(250, 20, 1000)), kWholeWay);
          board.about("fingers that open freely");
          const auto opening = board.keep_asking(with_gripper(to(0, 20, 1000)), 400ms);
          board.expect_between(opening, "gripper.current", 1, 1000);
        },
        kFull),

    must("parol6.gripper.current-any", "A current beyond 1300 mA is passed on.", "firmware",
         Profiles::kFirmware, "parol6.gripper.current-range"),
    grip(
        "Something held with 2000 mA shows as -2000.",
        [](BoardBench& board) { board.expect(hold(board, 2000), "gripper.current", -2000); },
        kFull),

    must("parol6.gripper.current-range",
         "A commanded current beyond 0 to 1300 mA is passed on as the nearest of the two.",
         "document, gripper", Profiles::kDocumented, "parol6.gripper.current-any"),
    grip(
        "Something held with 2000 mA shows as -1300.",
        [](BoardBench& board) { board.expect(hold(board, 2000), "gripper.current", -1300); },
        kFull),

    must(
        "parol6.gripper.whose-answer",
        "Only an answer from the node of the latched frame is taken; an id above 15 never matches.",
        "firmware, vector G1"),
    grip(
        "Answers of node 0 are not shown for id 16.",
        [](BoardBench& board) {
          prepare(board, 60);
          board.about("a set-point for id 16");
          expect_at(board, board.keep_asking(with_gripper(elsewhere(16)), kWholeWay), 60);
        },
        kFull),

    must("parol6.gripper.id-low-bits",
         "Of the gripper id the low four bits say who is asked: 16 moves node 0.",
         "firmware, vector G1"),
    grip(
        "A set-point for id 16 moves node 0.",
        [](BoardBench& board) {
          prepare(board, 60);
          board.keep_asking(with_gripper(elsewhere(16)), kWholeWay);
          board.about("a set-point for id 16, then polls of id 0");
          board.act(idle());
          board.act(idle());
          expect_at(board, board.ask(idle()), 160);
        },
        kFull),

    must("parol6.gripper.other-node",
         "Set-points for another node do not move the gripper, and telemetry keeps what it showed.",
         "firmware, vector G2"),
    grip(
        "A set-point for node 3 moves nothing here.",
        [](BoardBench& board) {
          prepare(board, 60);
          board.about("a set-point for node 3");
          expect_at(board, board.keep_asking(with_gripper(elsewhere(3)), kWholeWay), 60);
          board.act(idle());
          board.act(idle());
          expect_at(board, board.ask(idle()), 60);
        },
        kFull),

    must("parol6.gripper.whose-frame",
         "Calibration and clear-error go to the node of the gripper id, as set-points do.",
         "firmware: one id for all three"),
    variant("clear-error",
            grip(
                "Clear-error for node 3 leaves a calibration alone, for node 0 it does not.",
                [](BoardBench& board) {
                  prepare(board, 200);
                  board.act(with_gripper({.mode = gripper_mode::kCalibrate}));
                  board.keep_asking(idle(), 100ms);
                  board.act(with_gripper({.mode = gripper_mode::kClearError, .id = 3}));
                  board.about("clear-error for node 3 in a calibration");
                  expect_moves(board, {});
                  constexpr std::uint8_t kOtherBits = 0x03;
                  board.act(
                      with_gripper({.command = kOtherBits, .mode = gripper_mode::kClearError}));
                  board.about("clear-error for node 0 in a calibration");
                  expect_stands(board, {});
                },
                kFull)),
    variant("calibration",
            grip(
                "A calibration for node 3 leaves this one calibrated.",
                [](BoardBench& board) {
                  prepare(board, 60);
                  board.act(with_gripper({.mode = gripper_mode::kCalibrate, .id = 3}));
                  board.act(idle());
                  board.act(idle());
                  board.about("a calibration for node 3");
                  board.expect_bits(board.ask(idle()), "gripper.status",
                                    gripper_status::kCalibrated, gripper_status::kCalibrated);
                },
                kFull)),

    must("parol6.gripper.while-disabled",
         "Set-points reach the gripper also while the board is disabled.",
         "firmware: sent when a frame is accepted"),
    grip(
        "A disabled board passes set-points on.",
        [](BoardBench& board) {
          prepare(board, 0);
          board.act(with_set_point(with_code(kDisable), to(0)));
          expect_follows(board, with_code(kDisable), 120);
          expect_follows(board, idle(), 20);
          board.act(with_code(kEnable));
        },
        kFull),

    must("parol6.gripper.any-code",
         "Set-points reach the gripper whatever the command of their frame is.",
         "firmware: sent when a frame is accepted"),
    grip(
        "Six codes bring set-points.",
        [](BoardBench& board) {
          prepare(board, 0);
          int place = 20;
          for (const int code : {0, 42, 101, 103, 200, 255}) {
            expect_follows(board, with_code(code), place);
            place += 30;
          }
        },
        kFull),
    variant("home", full(from(kHomed, Hazard::kHome, "The gripper closes while home is held.",
                              [](BoardBench& board) {
                                open_gripper(board);
                                board.about("one second of code 100");
                                expect_closed_by(board, gripping(kHome, to(200, 100)), 1s);
                                board.act(with_code(kEnable));
                              }))),
    variant("demo", full(from(kFresh, Hazard::kMove, "The gripper closes in the demonstration.",
                              [](BoardBench& board) {
                                board.spoil();
                                open_gripper(board);
                                board.about("one second of code 69");
                                expect_closed_by(board, gripping(kDemo, to(200, 100)), 1s);
                              }))),

    must("parol6.gripper.while-moving",
         "Set-points reach the gripper while joints jog, go or home, and do not disturb them.",
         "firmware: sent when a frame is accepted"),
    variant("jog", grip(
                       "The gripper moves in a jog, which goes on.",
                       [](BoardBench& board) {
                         prepare(board, 0);
                         board.act(with_set_point(jog(4, 200), to(0)));
                         const auto before = board.ask(with_set_point(jog(4, 200), to(0)));
                         expect_follows(board, jog(4, 200), 120);
                         const auto after = board.ask(with_set_point(jog(4, 200), to(120, 200)));
                         board.about("a jog while the gripper is told to move");
                         expect_speed(board, {before, after}, 4, 200);
                         board.act(idle());
                       },
                       kFull)),
    variant("go-to", with(grip(
                              "The gripper moves in a go-to, which arrives.",
                              [](BoardBench& board) {
                                prepare(board, 0);
                                const auto rest = board.ask(idle());
                                const auto frame = go_to(beside(rest, 4, 80));
                                expect_follows(board, frame, 120);
                                board.about("a go-to while the gripper is told to move");
                                board.expect(board.ask(with_set_point(frame, to(120, 200))),
                                             "position.j5", rest.position[4].value + 80);
                                board.act(idle());
                              },
                              kFull),
                          kHomed)),
    variant("home", grip(
                        "The gripper moves during homing, which goes on.",
                        [](BoardBench& board) {
                          prepare(board, 0);
                          begin_homing(board, 20ms);
                          expect_follows(board, idle(), 120);
                          board.about("homing while the gripper is told to move");
                          expect_speed(board, run(board, idle(), 100ms), kJ2, kHoming[kJ2].seek);
                          board.act(with_code(kEnable));
                        },
                        kFull)),

    must("parol6.gripper.moves-when",
         "The gripper moves only if activated, told to go and calibrated.", "gripper"),
    variant("calibrated",
            with(grip("A gripper that is not calibrated stands.",
                      [](BoardBench& board) {
                        board.act(idle());
                        board.act(idle());
                        const auto answer = board.ask(idle());
                        if (is_untold(answer))
                          return board.leave_open("no gripper answers on the board's CAN");
                        if (is_calibrated(answer))
                          return board.leave_open("the gripper is calibrated at power-up");
                        board.about("a set-point without a calibration");
                        expect_stands(board, to(200));
                      }),
                 kFresh)),
    variant("activated",
            grip(
                "A gripper that is not activated stands.",
                [](BoardBench& board) { expect_asleep(board, gripper_command::kGoTo); }, kFull)),
    variant("told", grip(
                        "A gripper that is not told to go stands.",
                        [](BoardBench& board) { expect_asleep(board, gripper_command::kActivate); },
                        kFull)),

    must("parol6.gripper.object-code",
         "An object that stops the closing gripper is object 1, with the low bit in 20; on the way "
         "it "
         "is 0, at the position 3.",
         "gripper; drives before 2025-09-29 have 1 and 2 the other way round"),
    grip(
        "The object code is 0 on the way and 3 at the position.",
        [](BoardBench& board) {
          constexpr std::uint8_t kObject = 0x30;
          prepare(board, 0);
          board.act(with_gripper(to(250, 20)));
          board.keep_asking(with_gripper(to(250, 20)), 100ms);
          board.about("on the way");
          board.expect_bits(board.ask(with_gripper(to(250, 20))), "gripper.status", kObject, 0);
          board.about("at the position");
          board.expect_bits(board.keep_asking(with_gripper(to(250, 60)), kWholeWay),
                            "gripper.status", kObject, 0x30);
        },
        kFull),
    variant("held", grip(
                        "Something between the fingers is object 1.",
                        [](BoardBench& board) {
                          board.expect_bits(hold(board, 300), "gripper.status", 0x30, 0x20);
                        },
                        kFull)),

    must("parol6.gripper.stop",
         "The stop flag stops the gripper and latches the stop error in status bit 02.", "gripper"),
    grip(
        "The stop flag stops the gripper and is an error.",
        [](BoardBench& board) {
          prepare(board, 0);
          board.keep_asking(with_gripper(to(250, 20)), 200ms);
          board.act(with_gripper(stopping(250)));
          board.about("the stop flag on the way");
          expect_stands(board, stopping(250));
          board.expect_bits(board.ask(with_gripper(stopping(250))), "gripper.status",
                            gripper_status::kEstopError, gripper_status::kEstopError);
          board.act(with_gripper(in_mode(to(250), 0)));
          board.act(with_gripper(in_mode(to(250), 2)));
        },
        kFull),

    must("parol6.gripper.stop-stays",
         "Clear-error does not take the stop error back while the set-points ask for the stop.",
         "gripper"),
    grip(
        "Clear-error with the stop flag leaves the error.",
        [](BoardBench& board) {
          prepare(board, 60);
          board.act(with_gripper(stopping(250)));
          board.act(with_gripper(in_mode(stopping(250), gripper_mode::kClearError)));
          board.act(with_gripper(stopping(250)));
          board.about("clear-error while the stop is asked for");
          board.expect_bits(board.ask(with_gripper(stopping(250))), "gripper.status",
                            gripper_status::kEstopError, gripper_status::kEstopError);
          board.act(with_gripper(in_mode(to(60), 0)));
          board.act(with_gripper(in_mode(to(60), gripper_mode::kClearError)));
        },
        kFull),

    must("parol6.gripper.clear-error", "Clear-error ends a calibration and leaves the drive idle.",
         "gripper"),
    grip(
        "Clear-error stops a calibration.",
        [](BoardBench& board) {
          prepare(board, 200);
          board.act(with_gripper({.mode = gripper_mode::kCalibrate}));
          board.keep_asking(idle(), 200ms);
          board.act(with_gripper({.mode = gripper_mode::kClearError}));
          board.about("clear-error in a calibration");
          expect_stands(board, {});
        },
        kFull),

    unobservable(
        kHidden,
        must(
            "parol6.gripper.one-frame",
            "Each accepted serial frame sends exactly one CAN frame, chosen by mode and by whether "
            "anything changed.",
            "firmware")),

    unobservable(kHidden, must("parol6.gripper.calibration",
                               "Calibration opens with 500 mA at speed byte 40 until velocity is "
                               "at most 700 counts/s and "
                               "the current within 90 mA of 500 for 3200 interrupts, waits 20 ms, "
                               "closes the same way, and "
                               "is given up after 150,000 interrupts; after it the drive is idle.",
                               "gripper")),
};

}  // namespace

Chapter gripper_chapter() { return chapter("Gripper", kGripperClauses); }

}  // namespace armjig::parol6::conformance
