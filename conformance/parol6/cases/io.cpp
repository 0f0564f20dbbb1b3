// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr std::uint8_t kBoth = io_flag::kOut1 | io_flag::kOut2;
constexpr std::uint8_t kOutputs[] = {io_flag::kOut1, io_flag::kOut2, kBoth, 0};

CommandFrame with_outputs(CommandFrame frame, std::uint8_t outputs) {
  frame.in_out = outputs;
  return frame;
}

void expect_outputs(BoardBench& board, const CommandFrame& frame) {
  for (const auto outputs : kOutputs) {
    board.about(fmt::format("code {}", static_cast<int>(frame.command)));
    board.expect_bits(board.ask(with_outputs(frame, outputs)), "io", kBoth, outputs);
  }
}

void outputs(BoardBench& board) { expect_outputs(board, idle()); }

void output_bits(BoardBench& board) {
  const auto off = board.ask(idle());
  board.expect(off, "io", off.io & ~kBoth);
  board.expect(board.ask(with_outputs(idle(), 0x20)), "io", off.io | 0x20);
  board.expect(board.ask(with_outputs(idle(), 0x10)), "io", off.io | 0x10);
  board.expect(board.ask(idle()), "io", off.io);
}

void other_bits(BoardBench& board) {
  const auto off = board.ask(idle());
  for (const int bit : {0x80, 0x40, 0x08, 0x04, 0x02, 0x01}) {
    board.about(fmt::format("in_out = {:02X}", bit));
    board.expect(board.ask(with_outputs(idle(), static_cast<std::uint8_t>(bit))), "io", off.io);
  }
}

void outputs_always(BoardBench& board) {
  const auto rest = board.ask(idle()).position;
  for (const int code : {0, 42, 101, 103, 200, 255, 102}) expect_outputs(board, with_code(code));
  for (const int code : {255, 100, 123, 103}) expect_outputs(board, with_code(code));
  expect_outputs(board, go_to(rest));
  board.act(with_code(101));
  board.act(idle());
}

void outputs_of_jog(BoardBench& board) {
  const auto frame = jog(4, 300);
  const auto before = run(board, frame, 20ms).after;
  expect_outputs(board, frame);
  board.pause(50ms);
  const auto after = board.ask(frame);
  board.about("a jog while outputs change");
  expect_speed(board, {before, after}, 4, 300);
  board.act(idle());
}

void outputs_of_go_to(BoardBench& board) {
  const auto start = board.ask(idle());
  const auto frame = go_to(beside(start, 4, 100));
  expect_outputs(board, frame);
  board.about("a go-to while outputs change");
  board.expect(board.keep_asking(frame, 400ms), "position.j5", start.position[4].value + 100);
  board.act(idle());
}

void outputs_of_homing(BoardBench& board) {
  begin_homing(board, 50ms);
  expect_outputs(board, idle());
  const auto stretch = run(board, idle(), 100ms);
  board.about("homing while outputs change");
  expect_speed(board, stretch, 0, -2050);
  board.act(with_code(101));
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

void in1_bit(BoardBench& board) {
  expect_input(board, "in1", io_flag::kIn1);
  board.touch("in1", 0);
}

void in2_bit(BoardBench& board) {
  expect_input(board, "in2", io_flag::kIn2);
  board.touch("in2", 0);
}

void estop_bit(BoardBench& board) { expect_input(board, "estop", io_flag::kEstopReleased); }

void sampled(BoardBench& board) {
  for (int i = 0; i < 6; ++i) {
    board.touch("in1", i % 2);
    board.touch("in2", i % 3 == 0 ? 1 : 0);
    const auto wanted = (i % 2 != 0 ? io_flag::kIn1 : 0) | (i % 3 == 0 ? io_flag::kIn2 : 0);
    board.about(fmt::format("in1 {}, in2 {}", i % 2, i % 3 == 0 ? 1 : 0));
    board.expect_bits(board.ask(idle()), "io", io_flag::kIn1 | io_flag::kIn2,
                      static_cast<std::uint8_t>(wanted));
  }
  board.touch("in1", 0);
  board.touch("in2", 0);
}

void inputs_always(BoardBench& board) {
  for (const int code : {0, 42, 101, 103, 123, 255, 102, 100, 156, 103, 255}) {
    for (const int level : {1, 0}) {
      board.touch("in1", level);
      board.about(fmt::format("in1 = {} and code {}", level, code));
      board.expect_bits(board.ask(with_code(code)), "io", io_flag::kIn1,
                        level != 0 ? io_flag::kIn1 : std::uint8_t{0});
    }
  }
  board.act(with_code(101));
  board.act(idle());
}

void press(BoardBench& board) { board.touch("estop", 0); }
void press_while_jogging(BoardBench& board) {
  board.spoil();
  board.act(jog(4, 500));
  press(board);
}
void release(BoardBench& board) { board.touch("estop", 1); }

void expect_jog(BoardBench& board, std::string_view what) {
  board.about(std::string{what});
  expect_speed(board, run(board, jog(4, 500), 100ms), 4, 500);
}
void expect_no_jog(BoardBench& board, std::string_view what) {
  board.about(std::string{what});
  expect_still(board, jog(4, 500), 100ms);
}

void estop_reported(BoardBench& board) {
  press_while_jogging(board);
  const auto stretch = run(board, jog(4, 500), 100ms);
  board.about("a jog with the emergency stop pressed");
  board.expect_bits(stretch.after, "io", io_flag::kEstopReleased, 0);
  expect_speed(board, stretch, 4, 500);
  release(board);
  expect_jog(board, "the same jog when it is released");
}

void estop_disables(BoardBench& board) {
  press_while_jogging(board);
  board.pause(BoardBench::kPassTime);
  expect_no_jog(board, "a jog with the emergency stop pressed");
  release(board);
}

void estop_released(BoardBench& board) {
  board.spoil();
  press(board);
  board.act(idle());
  release(board);
  expect_no_jog(board, "a jog after the emergency stop was released");
  board.act(with_code(101));
  expect_jog(board, "a jog after enable");
}

void estop_ignored_by_enable(BoardBench& board) {
  board.spoil();
  board.act(with_code(102));
  press(board);
  board.act(with_code(101));
  expect_jog(board, "a jog after enable, the emergency stop being pressed");
  release(board);
}

void estop_holds(BoardBench& board) {
  board.spoil();
  press(board);
  board.act(with_code(101));
  expect_no_jog(board, "a jog after enable, the emergency stop being pressed");
  release(board);
}

void estop_ignored_by_homing(BoardBench& board) {
  board.spoil();
  press(board);
  board.about("homing with the emergency stop pressed");
  begin_homing(board, 20ms);
  expect_speed(board, run(board, idle(), 100ms), 0, -2050);
  release(board);
}

void estop_ends_homing(BoardBench& board) {
  board.spoil();
  begin_homing(board, 50ms);
  press(board);
  board.act(idle());
  board.about("homing with the emergency stop pressed");
  expect_still(board, idle(), 100ms);
  release(board);
  board.about("homing after the emergency stop was released");
  expect_still(board, idle(), 100ms);
}

constexpr Case kCases[] = {
    from(kListening, Hazard::kState, "parol6.telemetry.outputs",
         "Outputs are shown by the frame that sets them.", on<outputs>),
    from(kListening, Hazard::kState, "parol6.io.output-bits",
         "Each output bit sets its own output alone.", on<output_bits>),
    {.requirement = "parol6.io.other-bits",
     .rule = "Six other bits of in_out change nothing in io.",
     .run = on<other_bits>},
    from(kHomed, Hazard::kHome, "parol6.io.outputs-always",
         "Outputs switch with every code, enabled and disabled.", on<outputs_always>),
    from(kEnabled, Hazard::kMove, "parol6.io.outputs-moving",
         "Outputs switch in a jog, which goes on.", on<outputs_of_jog>, "jog"),
    from(kHomed, Hazard::kMove, "parol6.io.outputs-moving",
         "Outputs switch in a go-to, which arrives.", on<outputs_of_go_to>, "go-to"),
    from(kEnabled, Hazard::kHome, "parol6.io.outputs-moving",
         "Outputs switch during homing, which goes on.", on<outputs_of_homing>, "home"),
    {.requirement = "parol6.io.sampled",
     .rule = "Six changes of IN1 and IN2 show in the very next answers.",
     .run = on<sampled>},
    {.requirement = "parol6.io.in1-bit", .rule = "IN1 shows in its bit.", .run = on<in1_bit>},
    {.requirement = "parol6.io.in2-bit", .rule = "IN2 shows in its bit.", .run = on<in2_bit>},
    from(kListening, Hazard::kState, "parol6.io.estop-bit", "The emergency stop shows in its bit.",
         on<estop_bit>),
    from(kEnabled, Hazard::kHome, "parol6.io.inputs-always",
         "IN1 shows in answers to every code, enabled and disabled.", on<inputs_always>),
    from(kEnabled, Hazard::kMove, "parol6.io.estop-reported",
         "A jog goes on while the stop is pressed.", on<estop_reported>),
    from(kEnabled, Hazard::kMove, "parol6.io.estop-disables",
         "A jog ends when the stop is pressed.", on<estop_disables>),
    from(kEnabled, Hazard::kMove, "parol6.io.estop-released-stays-disabled",
         "After the stop is released only enable lets a joint jog.", on<estop_released>),
    from(kEnabled, Hazard::kMove, "parol6.io.estop-ignored-by-enable",
         "A disabled board can be enabled and jogs while the stop is pressed.",
         on<estop_ignored_by_enable>),
    from(kEnabled, Hazard::kMove, "parol6.io.estop-holds",
         "Enable has no effect while the stop is pressed.", on<estop_holds>),
    from(kEnabled, Hazard::kHome, "parol6.io.estop-ignored-by-homing",
         "Homing seeks while the stop is pressed.", on<estop_ignored_by_homing>),
    from(kEnabled, Hazard::kHome, "parol6.io.estop-ends-homing",
         "Homing ends when the stop is pressed, for good.", on<estop_ends_homing>),
};

}  // namespace

std::span<const Case> io_cases() noexcept { return kCases; }

}  // namespace armjig::parol6::conformance
