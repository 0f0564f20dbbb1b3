// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr std::uint8_t kOutputs[] = {io_flag::kOut1, io_flag::kOut2, io_flag::kOutputs, 0};

CommandFrame with_outputs(CommandFrame frame, std::uint8_t outputs) {
  frame.in_out = outputs;
  return frame;
}

void expect_outputs(BoardBench& board, const CommandFrame& frame) {
  for (const auto outputs : kOutputs) {
    board.about(fmt::format("code {}", static_cast<int>(frame.command)));
    board.expect_bits(board.ask(with_outputs(frame, outputs)), "io", io_flag::kOutputs, outputs);
  }
}

/// The bit follows the input, frame by frame, and the others stay.
void expect_input(BoardBench& board, std::string_view input, std::uint8_t mask) {
  board.touch(input, 0);
  const auto low = board.ask(idle());
  board.touch(input, 1);
  const auto high = board.ask(idle());
  board.about(fmt::format("{} low, then high", input));
  board.expect_bits(low, "io", mask, 0);
  board.expect(high, "io", low.io | mask);
}

void press(BoardBench& board) { board.touch("estop", 0); }

/// A guard lets nothing move, or go on moving, while the stop is pressed.
void needs_motion_while_pressed(BoardBench& board) {
  board.needs_emulation();
  board.spoil();
}

void press_while_jogging(BoardBench& board) {
  needs_motion_while_pressed(board);
  board.act(jog(4, 500));
  press(board);
}

void release(BoardBench& board) { board.touch("estop", 1); }

void expect_jog(BoardBench& board, std::string_view what) {
  board.about(std::string{what});
  expect_speed(board, run(board, jog(4, 500), 100ms), 4, 500);
}

void expect_jog_refused(BoardBench& board, std::string_view what) {
  board.about(std::string{what});
  expect_still(board, jog(4, 500), 100ms);
}

constexpr Clause kIoClauses[] = {
    must("parol6.telemetry.outputs", "The answer shows both outputs as its own frame set them.",
         "firmware: outputs are written before the answer is made"),
    from(kListening, Hazard::kState, "Outputs are shown by the frame that sets them.",
         [](BoardBench& board) { expect_outputs(board, idle()); }),
    variant("stay",
            from(kListening, Hazard::kState, "Outputs stay on in a second frame that wants them.",
                 [](BoardBench& board) {
                   auto frame = idle();
                   frame.in_out = io_flag::kOutputs;
                   board.ask(frame);
                   board.about("the second frame with both outputs");
                   board.expect_bits(board.ask(frame), "io", frame.in_out, frame.in_out);
                   board.ask(idle());
                 })),

    must(
        "parol6.io.output-bits",
        "OUT1 is bit 20 and OUT2 bit 10, in commands and in telemetry, and neither sets the other.",
        "document, packet tables; firmware"),
    from(kListening, Hazard::kState, "Each output bit sets its own output alone.",
         [](BoardBench& board) {
           const auto off = board.ask(idle());
           board.expect(off, "io", off.io & ~io_flag::kOutputs);
           board.expect(board.ask(with_outputs(idle(), 0x20)), "io", off.io | 0x20);
           board.expect(board.ask(with_outputs(idle(), 0x10)), "io", off.io | 0x10);
           board.expect(board.ask(idle()), "io", off.io);
         }),

    must("parol6.io.other-bits",
         "The other bits of in_out set nothing: IN1, IN2 and the stop come from pins.",
         "firmware: only OUT1 and OUT2 are used"),
    look("Six other bits of in_out change nothing in io.",
         [](BoardBench& board) {
           const auto off = board.ask(idle());
           for (const int bit : {0x80, 0x40, 0x08, 0x04, 0x02, 0x01}) {
             board.about(fmt::format("in_out = {:02X}", bit));
             board.expect(board.ask(with_outputs(idle(), static_cast<std::uint8_t>(bit))), "io",
                          off.io);
           }
         }),

    must("parol6.io.outputs-always",
         "Outputs follow every frame, whatever its command, also while the board is disabled.",
         "firmware: they are written when a frame is accepted"),
    from(kHomed, Hazard::kHome, "Outputs switch with every code, enabled and disabled.",
         [](BoardBench& board) {
           const auto rest = board.ask(idle()).position;
           for (const int code : {0, 42, 101, 103, 200, 255, 102})
             expect_outputs(board, with_code(code));
           for (const int code : {255, 100, 123, 103}) expect_outputs(board, with_code(code));
           expect_outputs(board, go_to(rest));
           board.act(with_code(kEnable));
           board.act(idle());
         }),

    must("parol6.io.outputs-moving",
         "Outputs follow every frame while joints move, and their change does not disturb the "
         "motion.",
         "firmware: they are written when a frame is accepted"),
    variant("jog", from(kEnabled, Hazard::kMove, "Outputs switch in a jog, which goes on.",
                        [](BoardBench& board) {
                          const auto frame = jog(4, 300);
                          const auto before = run(board, frame, 20ms).after;
                          expect_outputs(board, frame);
                          board.pause(50ms);
                          const auto after = board.ask(frame);
                          board.about("a jog while outputs change");
                          expect_speed(board, {before, after}, 4, 300);
                          board.act(idle());
                        })),
    variant("go-to", from(kHomed, Hazard::kMove, "Outputs switch in a go-to, which arrives.",
                          [](BoardBench& board) {
                            const auto start = board.ask(idle());
                            const auto frame = go_to(beside(start, 4, 100));
                            expect_outputs(board, frame);
                            board.about("a go-to while outputs change");
                            board.expect(board.keep_asking(frame, 400ms), "position.j5",
                                         start.position[4].value + 100);
                            board.act(idle());
                          })),
    variant("home", from(kEnabled, Hazard::kHome, "Outputs switch during homing, which goes on.",
                         [](BoardBench& board) {
                           begin_homing(board, 50ms);
                           expect_outputs(board, idle());
                           const auto stretch = run(board, idle(), 100ms);
                           board.about("homing while outputs change");
                           expect_speed(board, stretch, kJ1, kHoming[kJ1].seek);
                           board.act(with_code(kEnable));
                         })),
    variant("demo", full(from(kFresh, Hazard::kMove, "OUT1 goes on in the demonstration.",
                              [](BoardBench& board) {
                                board.spoil();
                                auto frame = with_code(kDemo);
                                board.ask(frame);
                                frame.in_out = io_flag::kOut1;
                                board.about("code 69");
                                board.expect_bits(board.ask(frame), "io", io_flag::kOut1,
                                                  io_flag::kOut1);
                              }))),

    must("parol6.io.sampled",
         "IN1, IN2 and the emergency stop are the levels at the moment when the frame is accepted.",
         "firmware: pins are read when a frame is accepted"),
    look("Six changes of IN1 and IN2 show in the very next answers.",
         [](BoardBench& board) {
           for (int i = 0; i < 6; ++i) {
             board.touch("in1", i % 2);
             board.touch("in2", i % 3 == 0 ? 1 : 0);
             const auto wanted =
                 (i % 2 != 0 ? io_flag::kIn1 : 0) | (i % 3 == 0 ? io_flag::kIn2 : 0);
             board.about(fmt::format("in1 {}, in2 {}", i % 2, i % 3 == 0 ? 1 : 0));
             board.expect_bits(board.ask(idle()), "io", io_flag::kIn1 | io_flag::kIn2,
                               static_cast<std::uint8_t>(wanted));
           }
           board.touch("in1", 0);
           board.touch("in2", 0);
         }),

    must("parol6.io.in1-bit", "IN1 is bit 80 of io, 1 when it is high.",
         "document, packet table; firmware, vector F10"),
    look("IN1 shows in its bit.",
         [](BoardBench& board) {
           expect_input(board, "in1", io_flag::kIn1);
           board.touch("in1", 0);
         }),

    must("parol6.io.in2-bit", "IN2 is bit 40 of io, 1 when it is high.",
         "document, packet table; firmware, vector F10"),
    look("IN2 shows in its bit.",
         [](BoardBench& board) {
           expect_input(board, "in2", io_flag::kIn2);
           board.touch("in2", 0);
         }),

    must("parol6.io.estop-bit", "The emergency stop is bit 08 of io: 1 is released, 0 pressed.",
         "document, packet table; firmware, vector F10"),
    from(kListening, Hazard::kState, "The emergency stop shows in its bit.",
         [](BoardBench& board) { expect_input(board, "estop", io_flag::kEstopReleased); }),

    must(
        "parol6.io.inputs-always",
        "Inputs are shown in every answer, whatever the command, also while the board is disabled.",
        "firmware: pins are read when a frame is accepted"),
    from(kEnabled, Hazard::kHome, "IN1 shows in answers to every code, enabled and disabled.",
         [](BoardBench& board) {
           for (const int code : {0, 42, 101, 103, 123, 255, 102, 100, 156, 103, 255}) {
             for (const int level : {1, 0}) {
               board.touch("in1", level);
               board.about(fmt::format("in1 = {} and code {}", level, code));
               board.expect_bits(board.ask(with_code(code)), "io", io_flag::kIn1,
                                 level != 0 ? io_flag::kIn1 : std::uint8_t{0});
             }
           }
           board.act(with_code(kEnable));
           board.act(idle());
         }),

    must("parol6.io.estop-reported", "A pressed emergency stop is reported and stops no joint.",
         "firmware", Profiles::kFirmware, "parol6.io.estop-disables"),
    from(kEnabled, Hazard::kMove, "A jog goes on while the stop is pressed.",
         [](BoardBench& board) {
           press_while_jogging(board);
           const auto stretch = run(board, jog(4, 500), 100ms);
           board.about("a jog with the emergency stop pressed");
           board.expect_bits(stretch.after, "io", io_flag::kEstopReleased, 0);
           expect_speed(board, stretch, 4, 500);
           release(board);
           expect_jog(board, "the same jog when it is released");
         }),

    must("parol6.io.estop-disables",
         "A pressed emergency stop stops all joints and disables the board.",
         "document: the stop is a safety function", Profiles::kDocumented,
         "parol6.io.estop-reported"),
    from(kEnabled, Hazard::kMove, "A jog ends when the stop is pressed.",
         [](BoardBench& board) {
           press_while_jogging(board);
           board.pause(BoardBench::kPassTime);
           expect_jog_refused(board, "a jog with the emergency stop pressed");
           release(board);
         }),

    must("parol6.io.estop-ignored-by-enable",
         "The board can be enabled while the emergency stop is pressed.", "firmware",
         Profiles::kFirmware, "parol6.io.estop-holds"),
    from(kEnabled, Hazard::kMove,
         "A disabled board can be enabled and jogs while the stop is pressed.",
         [](BoardBench& board) {
           board.needs_emulation();
           spoil_disabled(board);
           press(board);
           board.act(with_code(kEnable));
           expect_jog(board, "a jog after enable, the emergency stop being pressed");
           release(board);
         }),

    must("parol6.io.estop-holds", "Nothing enables the board while the emergency stop is pressed.",
         "document: the stop is a safety function", Profiles::kDocumented,
         "parol6.io.estop-ignored-by-enable"),
    from(kEnabled, Hazard::kMove, "Enable has no effect while the stop is pressed.",
         [](BoardBench& board) {
           needs_motion_while_pressed(board);
           press(board);
           board.act(with_code(kEnable));
           expect_jog_refused(board, "a jog after enable, the emergency stop being pressed");
           release(board);
         }),

    must("parol6.io.estop-ignored-by-homing", "Homing goes on while the emergency stop is pressed.",
         "firmware", Profiles::kFirmware, "parol6.io.estop-ends-homing"),
    from(kEnabled, Hazard::kHome, "Homing seeks while the stop is pressed.",
         [](BoardBench& board) {
           needs_motion_while_pressed(board);
           press(board);
           board.about("homing with the emergency stop pressed");
           begin_homing(board, 20ms);
           expect_speed(board, run(board, idle(), 100ms), kJ1, kHoming[kJ1].seek);
           release(board);
         }),

    must("parol6.io.estop-ends-homing",
         "A pressed emergency stop ends homing, and releasing it does not resume it.",
         "document: the stop is a safety function", Profiles::kDocumented,
         "parol6.io.estop-ignored-by-homing"),
    from(kEnabled, Hazard::kHome, "Homing ends when the stop is pressed, for good.",
         [](BoardBench& board) {
           needs_motion_while_pressed(board);
           begin_homing(board, 50ms);
           press(board);
           board.act(idle());
           board.about("homing with the emergency stop pressed");
           expect_still(board, idle(), 100ms);
           release(board);
           board.about("homing after the emergency stop was released");
           expect_still(board, idle(), 100ms);
         }),

    must("parol6.io.estop-released-stays-disabled",
         "Releasing the emergency stop does not enable the board by itself.",
         "document: the user has to enable again", Profiles::kDocumented,
         "parol6.io.estop-reported"),
    from(kEnabled, Hazard::kMove, "After the stop is released only enable lets a joint jog.",
         [](BoardBench& board) {
           board.spoil();
           press(board);
           board.act(idle());
           release(board);
           expect_jog_refused(board, "a jog after the emergency stop was released");
           board.act(with_code(kEnable));
           expect_jog(board, "a jog after enable");
         }),
};

}  // namespace

Chapter io_chapter() { return chapter("Inputs, outputs and emergency stop", kIoClauses); }

}  // namespace armjig::parol6::conformance
