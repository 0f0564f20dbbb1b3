// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/gripper_cases.hpp"

namespace armjig::parol6::conformance {
namespace {

GripperSetPoint stopping(int place) {
  auto set_point = to(place);
  set_point.command |= gripper_command::kEstop;
  return set_point;
}

void expect_asleep(BoardBench& board, std::uint8_t command) {
  prepare(board, 0);
  auto set_point = to(200);
  set_point.command = command;
  board.about(fmt::format("a gripper command of {:02X}", command));
  expect_stands(board, set_point);
}

/// An end counts for the gripper with currents of 410 to 590 mA.
void expect_pressing_calibration(BoardBench& board) {
  prepare(board, 100);
  board.act(with_gripper({.mode = gripper_mode::kCalibrate}));
  board.act(idle());
  int least = 0;
  int most = 0;
  const auto is_over = [&](const Answer& answer) {
    least = std::min<int>(least, answer.gripper.current.value);
    most = std::max<int>(most, answer.gripper.current.value);
    return is_calibrated(answer);
  };
  board.about("a calibration");
  board.expect_true(board.ask_until(idle(), is_over, 35s).has_value(),
                    "gripper.status with bit 01 within 35 s", "never");
  board.expect_true(most >= 410 && most <= 590 && least <= -410 && least >= -590,
                    "gripper.current of 410 to 590 mA at the one end, and negative at the other",
                    fmt::format("from {} to {} mA", least, most));
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

    variant("cut-off",
            grip(
                "What it answers is cut off: from both sides it is one less somewhere.",
                [](BoardBench& board) {
                  prepare(board, 0);
                  int less = 0;
                  for (const int place : {40, 90, 150, 210, 240, 190, 130, 80, 50, 20}) {
                    const auto there = board.keep_asking(with_gripper(to(place, 120)), 1s);
                    less += there.gripper.position == place - 1 ? 1 : 0;
                  }
                  board.expect_true(less > 0, "one less than was asked for at one of ten",
                                    "what was asked for or more at all");
                },
                kFull)),

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

    variant("held", grip(
                        "Held, it asks the gripper for nothing, and telemetry shows what it did.",
                        [](BoardBench& board) {
                          const auto calibrate = with_gripper({.mode = gripper_mode::kCalibrate});
                          prepare(board, 100);
                          board.act(calibrate);
                          const int before = board.ask(calibrate).gripper.position;
                          board.about("a calibration that is asked for all the time");
                          board.expect(board.keep_asking(calibrate, 800ms), "gripper.position",
                                       before);
                        },
                        kFull)),

    variant("presses", grip("It presses against both ends with about 500 mA, which are shown.",
                            on<expect_pressing_calibration>, kFull)),

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

    variant("no-current", grip(
                              "Fingers that may not use any current stand, and meet nothing.",
                              [](BoardBench& board) {
                                prepare(board, 0);
                                const auto weak = with_gripper(to(200, 60, 0));
                                board.about("a set-point with a current of 0");
                                board.expect_bits(board.keep_asking(weak, 500ms), "gripper.status",
                                                  0x30, 0);
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
