// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/gripper_cases.hpp"

namespace armjig::parol6::conformance {
namespace {

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

CommandFrame gripping(Command code, const GripperSetPoint& set_point) {
  auto frame = with_gripper(set_point);
  frame.command = code;
  return frame;
}

void expect_closed_by(BoardBench& board, const CommandFrame& frame, Duration time) {
  const auto before = board.ask(with_gripper(to(0, 60))).gripper.position;
  board.keep_asking(frame, time);
  const auto after = board.ask(frame).gripper.position;
  board.expect_true(after - before > 100, "the gripper to close by more than 100",
                    fmt::format("it went from {} to {}", before, after));
}

/// Set-points that are changed in that way start a drive that was left idle.
void expect_starts(BoardBench& board, std::string_view what, void (*change)(GripperSetPoint&)) {
  auto set_point = idle_on_the_way(board);
  change(set_point);
  board.about(std::string{what});
  expect_moves(board, set_point);
}

constexpr Clause kSetPointClauses[] = {
    must("parol6.gripper.idle-until-changed",
         "After calibration or clear-error the gripper stands until a set-point changes.",
         "gripper and firmware: unchanged set-points are only polls"),
    grip("Polls do not start an idle drive.", [](BoardBench& board) { idle_on_the_way(board); }),

    must("parol6.gripper.change-of-position", "A changed gripper position sends the set-points.",
         "firmware"),
    grip(
        "Another position starts an idle drive.",
        [](BoardBench& board) {
          expect_starts(board, "another position after clear-error",
                        [](GripperSetPoint& one) { one.position = 245; });
        },
        kFull),
    variant("high-byte", grip(
                             "One that differs in its high byte starts an idle drive.",
                             [](BoardBench& board) {
                               expect_starts(board, "a position 256 larger after clear-error",
                                             [](GripperSetPoint& one) { one.position += 256; });
                             },
                             kFull)),

    must("parol6.gripper.change-of-speed", "A changed gripper speed sends the set-points.",
         "firmware"),
    grip(
        "Another speed starts an idle drive.",
        [](BoardBench& board) {
          expect_starts(board, "another speed after clear-error",
                        [](GripperSetPoint& one) { one.speed = 21; });
        },
        kFull),
    variant("high-byte", grip(
                             "One that differs in its high byte starts an idle drive.",
                             [](BoardBench& board) {
                               expect_starts(board, "a speed 256 larger after clear-error",
                                             [](GripperSetPoint& one) { one.speed += 256; });
                             },
                             kFull)),

    must("parol6.gripper.change-of-current", "A changed gripper current sends the set-points.",
         "firmware"),
    grip(
        "Another current starts an idle drive.",
        [](BoardBench& board) {
          expect_starts(board, "another current after clear-error",
                        [](GripperSetPoint& one) { one.current = Milliamperes{401}; });
        },
        kFull),

    must("parol6.gripper.change-of-command", "A changed gripper command byte sends the set-points.",
         "firmware"),
    grip(
        "Another command byte starts an idle drive.",
        [](BoardBench& board) {
          expect_starts(
              board, "another release direction after clear-error",
              [](GripperSetPoint& one) { one.command |= gripper_command::kReleaseDirection; });
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

    variant("remembered", grip(
                              "What came in mode 7 was sent, so that what was before is a change.",
                              [](BoardBench& board) {
                                prepare(board, 100);
                                board.keep_asking(with_gripper(in_mode(to(150), 7)), kWholeWay);
                                board.about("set-points of mode 0 again after others in mode 7");
                                const auto back = with_gripper(to(100));
                                expect_at(board, board.keep_asking(back, kWholeWay), 100);
                              },
                              kFull)),

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
                                prepare(board, 0);
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
                                prepare(board, 0);
                                board.about("one second of code 100");
                                expect_closed_by(board, gripping(kHome, to(200, 100)), 1s);
                                board.act(with_code(kEnable));
                              }))),
    variant("demo", full(from(kFresh, Hazard::kMove, "The gripper closes in the demonstration.",
                              [](BoardBench& board) {
                                board.spoil();
                                prepare(board, 0);
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

    unobservable(
        kHidden,
        must(
            "parol6.gripper.one-frame",
            "Each accepted serial frame sends exactly one CAN frame, chosen by mode and by whether "
            "anything changed.",
            "firmware")),
};

}  // namespace

Chapter set_point_chapter() { return chapter("Set-points of the gripper", kSetPointClauses); }

}  // namespace armjig::parol6::conformance
