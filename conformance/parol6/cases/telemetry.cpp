// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>

#include "conformance/parol6/board_bench.hpp"
#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6 {
namespace {

using namespace std::chrono_literals;

/// Codes that neither move anything nor change a state.
constexpr std::array kHarmlessCodes{0, 1, 42, 99, 104, 122, 124, 155, 157, 200, 254, 255};

void layout(BoardBench& board) {
  const auto answer = board.ask(idle());
  board.expect(answer, "check", kCheckBoard);
  board.expect_bits(answer, "homed", 0x03, 0x03);
  board.expect_bits(answer, "io", 0x07, 0x07);
  board.expect_bits(answer, "temperature_error", 0x03, 0x03);
  board.expect_bits(answer, "position_error", 0x03, 0x03);
}

void constants(BoardBench& board) {
  const auto answer = board.ask(idle());
  board.expect(answer, "timeout_error", 100);
  board.expect(answer, "gripper.id", 0);
  board.expect(answer, "gripper.speed", 1);
  board.expect(answer, "gripper.object", 1);
}

void echo(BoardBench& board) {
  for (const auto code : kHarmlessCodes) board.expect(board.ask(with_code(code)), "echo", code);
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
  board.expect_true(above_least <= most - least,
                    fmt::format("timing of {:.0f} to {:.0f} ticks, modulo 65536", least, most),
                    fmt::format("{} ticks", after.timing));
}

void timing(BoardBench& board) {
  auto before = board.ask(idle());
  for (const auto gap : {5ms, 20ms, 60ms}) {
    board.pause(gap);
    const auto after = board.ask(idle());
    expect_interval(board, before, after);
    before = after;
  }
}

void idle_speed(BoardBench& board) {
  constexpr Speeds kSpeeds{1, -1, 255, -256, 40'000, -49'999};
  for (std::size_t turn = 0; turn < kJointCount; ++turn) {
    auto frame = idle();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      frame.speed[j] = StepsPerSecond{kSpeeds[(j + turn) % kSpeeds.size()]};
    }
    const auto before = board.act(frame);
    const auto after = board.ask(frame);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      board.expect(after, fmt::format("speed.j{}", j + 1), frame.speed[j].value);
      board.expect_same(after, fmt::format("position.j{}", j + 1), before);
    }
  }
}

void outputs(BoardBench& board) {
  constexpr auto kBoth = io_flag::kOut1 | io_flag::kOut2;
  for (const auto flags : {io_flag::kOut1, io_flag::kOut2, std::uint8_t{kBoth}, std::uint8_t{0}}) {
    auto frame = idle();
    frame.in_out = flags;
    board.expect_bits(board.ask(frame), "io", kBoth, flags);
  }
}

constexpr std::array kCases{
    Case{.requirement = "parol6.telemetry.layout",
         .rule = "Telemetry has its constant bytes.",
         .run = on<layout>},
    Case{.requirement = "parol6.telemetry.constants",
         .rule = "Fields that the firmware never computes keep their values.",
         .run = on<constants>},
    Case{.requirement = "parol6.telemetry.echo",
         .rule = "Codes without effect are echoed.",
         .run = on<echo>},
    Case{.requirement = "parol6.telemetry.timing",
         .rule = "The timing field measures the gap.",
         .run = on<timing>},
    Case{.requirement = "parol6.telemetry.idle-speed",
         .rule = "Speeds of idle frames come back, joint by joint.",
         .run = on<idle_speed>},
    Case{.requirement = "parol6.telemetry.outputs",
         .rule = "Outputs are shown by the frame that sets them.",
         .run = on<outputs>,
         .hazard = Hazard::kState},
};

}  // namespace

std::span<const Case> telemetry_cases() noexcept { return kCases; }

}  // namespace armjig::parol6
