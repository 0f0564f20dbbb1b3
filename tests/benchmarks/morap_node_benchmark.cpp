// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <chrono>

#include "emulators/i2c/bus.hpp"
#include "emulators/morap/node.hpp"

namespace armjig::morap {
namespace {

using namespace std::chrono_literals;

/// Writes `data` to the node at `address`; the end of the transaction.
Instant write(i2c::Bus& bus, Instant time, std::uint8_t address, Bytes data) {
  auto reply = bus.start(time, address, /*is_read=*/false);
  for (const auto byte : data) reply = bus.write(reply.end, byte);
  return bus.stop(reply.end).end;
}

/// Nodes that follow a new angle every 50 ms, their plants computed every 50 us. One iteration is a
/// second of virtual time; the counter is the speed against real time.
void run_nodes(benchmark::State& state, std::uint8_t count) {
  i2c::Bus bus;
  Instant time{};
  for (std::uint8_t id = 0; id < count; ++id) {
    const auto eeprom = emulation::dcx26l(id);
    bus.attach(emulation::Node{
        {.eeprom = eeprom, .plant = emulation::plant_of(eeprom.motor, 0.05, 0.041, 0.072)}});
    time = write(bus, time, node_address(id), encode(Command{CommandId::kCalibrateZero}));
  }
  bool is_forward = false;
  const auto stretch_of_motion = 50ms;
  for (auto _ : state) {
    for (int i = 0; i < 20; ++i) {
      is_forward = !is_forward;
      const auto next = time + stretch_of_motion;
      const auto target = encode(Command{CommandId::kPosition, is_forward ? 0.5F : -0.5F});
      for (std::uint8_t id = 0; id < count; ++id) {
        time = write(bus, time, node_address(id), target);
      }
      time = next;
      bus.advance_to(time);
    }
  }
  state.counters["times_real_time"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

/// Bar: 2,000 times real time.
void morap_node_closed_loop(benchmark::State& state) { run_nodes(state, 1); }
BENCHMARK(morap_node_closed_loop);

/// Bar: 120 times real time.
void morap_bus_of_sixteen(benchmark::State& state) { run_nodes(state, 16); }
BENCHMARK(morap_bus_of_sixteen);

}  // namespace
}  // namespace armjig::morap
