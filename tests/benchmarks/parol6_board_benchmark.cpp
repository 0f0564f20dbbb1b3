// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdint>

#include "emulators/parol6/board.hpp"

namespace armjig::parol6 {
namespace {

using namespace emulation;
using namespace std::chrono_literals;

constexpr BoardTiming kTiming{.pass_period = std::chrono::microseconds{20}};
constexpr auto kTick = 10ms;  // 100 Hz
constexpr int kTicksPerRound = 100;

enum class Loop : std::uint8_t { kFast, kPlain };

/// A host that sends a frame every 10 ms; `next_frame(tick)` makes it. One iteration is a second of
/// virtual time; the counter is the speed against real time.
template <class Prepare, class NextFrame>
void drive(benchmark::State& state, Prepare prepare, NextFrame next_frame) {
  Board board{standard_plant(), kTiming};
  if (static_cast<Loop>(state.range(0)) == Loop::kPlain) board.use_plain_loop();
  Instant now{};
  const auto send = [&](const CommandFrame& frame) {
    board.receive(now, encode(frame));
    now += kTick;
    board.advance_to(now - 1us);
    board.clear_sent();
  };
  prepare(send);
  std::int64_t tick = 0;
  for (auto _ : state) {
    for (int i = 0; i < kTicksPerRound; ++i) send(next_frame(tick++));
  }
  state.counters["times_real_time"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

CommandFrame command(Command code) {
  CommandFrame frame;
  frame.command = code;
  return frame;
}

constexpr auto kNoPreparation = [](auto&) {};

/// Bar: 50,000 times real time.
void board_idle(benchmark::State& state) {
  const auto idle = command(Command::kIdle);
  drive(state, kNoPreparation, [&](std::int64_t) { return idle; });
}
BENCHMARK(board_idle)->ArgName("plain")->Arg(0)->Arg(1);

/// Nobody talks to the board at all; one iteration is an hour.
void board_silent(benchmark::State& state) {
  Board board{standard_plant(), kTiming};
  Instant now{};
  for (auto _ : state) {
    now += 1h;
    board.advance_to(now);
  }
  state.counters["times_real_time"] = benchmark::Counter(
      3600.0 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(board_silent);

/// Six joints at 3,000 steps/s, a new direction every second. Bar: 20,000 times real time.
void board_jog(benchmark::State& state) {
  auto jog = command(Command::kJog);
  drive(state, kNoPreparation, [&](std::int64_t tick) {
    const bool is_forward = tick / 100 % 2 == 0;
    jog.speed.fill(StepsPerSecond{is_forward ? 3000 : -3000});
    return jog;
  });
}
BENCHMARK(board_jog)->ArgName("plain")->Arg(0)->Arg(1);

/// Six joints follow a target that moves at 3,000 steps/s. Bar: 3,000 times real time.
void board_go_to(benchmark::State& state) {
  auto go_to = command(Command::kGoTo);
  drive(state, kNoPreparation, [&](std::int64_t tick) {
    const auto phase = static_cast<std::int32_t>(tick % 200);
    const bool is_forward = phase < 100;
    go_to.position.fill(Steps{30 * (is_forward ? phase : 200 - phase)});
    go_to.speed.fill(StepsPerSecond{is_forward ? 3000 : -3000});
    return go_to;
  });
}
BENCHMARK(board_go_to)->ArgName("plain")->Arg(0)->Arg(1);

/// Homing over and over: 40 s, of which about 31 move. Bar: 3,000 times real time.
void board_homing(benchmark::State& state) {
  drive(state, kNoPreparation, [](std::int64_t tick) {
    return command(tick % 4000 == 0 ? Command::kHome : Command::kIdle);
  });
}
BENCHMARK(board_homing)->ArgName("plain")->Arg(0)->Arg(1)->MinTime(2.0);

}  // namespace
}  // namespace armjig::parol6
