// SPDX-License-Identifier: Apache-2.0
// KinovaZED: lines a second, and virtual against real time.
#include <benchmark/benchmark.h>

#include <string>

#include "emulators/kinovazed/server.hpp"
#include "harness/wire/kinovazed/line_splitter.hpp"

namespace armjig::kinovazed {
namespace {

using namespace emulation;
using namespace std::chrono_literals;

void parse_joystick_lines(benchmark::State& state) {
  std::string text;
  for (int i = 0; i < 4096; ++i) {
    const Command command{.verb = Verb::kMoveJoystick, .deflection = {i - 2048, -i, i * 7}};
    text += encode(command).view();
  }
  LineSplitter splitter;
  for (auto _ : state) {
    std::int64_t sum = 0;
    for (auto rest = std::as_bytes(std::span{text}); !rest.empty();) {
      const auto step = splitter.step(rest);
      rest = rest.subspan(step.used);
      const auto command = decode_command(step.line, Profile::kFirmware);
      if (command) sum += command->deflection.x;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(parse_joystick_lines);

/// Virtual seconds of steering a second; the counter is the factor to real time.
template <class Arm>
void steer(benchmark::State& state) {
  Server server{ArmPort{Arm{}}};
  auto now = at(60ms);
  const auto id = server.connect(now);
  const auto send = [&](std::string_view text, Duration wait) {
    server.receive(now, *id, std::as_bytes(std::span{text}));
    now += wait;
    server.advance_to(now);
  };
  send("QuitEStop\r\n", 1s);
  send("Initialize\r\n", 7s);
  send("SetJoystickMode:XYZ\r\n", 1s);
  std::int64_t seconds = 0;
  for (auto _ : state) {
    for (int i = 0; i < 10; ++i)
      send(i % 2 == 0 ? "MoveJoystick:40:0:9\r\n" : "MoveJoystick:-40:0:-9\r\n", 100ms);
    server.clear_sent();
    ++seconds;
  }
  state.counters["times_real_time"] =
      benchmark::Counter(static_cast<double>(seconds), benchmark::Counter::kIsRate);
}
BENCHMARK(steer<BenchArm>);
BENCHMARK(steer<JacoArm>);

}  // namespace
}  // namespace armjig::kinovazed
