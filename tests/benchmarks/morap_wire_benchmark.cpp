// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <array>
#include <cstring>

#include "harness/wire/morap/message.hpp"

namespace armjig::morap {
namespace {

/// The largest set there is: four coefficients in each filter.
ControllerSet largest_set() {
  const Coefficients filter{4, {0.1F, 0.2F, 0.3F, 0.4F}};
  return {ControllerKind::kPosition, 625, filter, filter, filter, 0.01F};
}

/// Baseline of all below: the bytes of the largest message copied. Bar of the others: at most twice
/// this plus 20 ns.
void morap_baseline_memcpy(benchmark::State& state) {
  const auto bytes = encode(Command{CommandId::kProgram, largest_set()});
  std::array<std::byte, kLargestWriteSize> copy{};
  auto size = bytes.size();
  for (auto _ : state) {
    benchmark::DoNotOptimize(size);
    std::memcpy(copy.data(), bytes.view().data(), size);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(morap_baseline_memcpy);

void morap_checksum(benchmark::State& state) {
  const auto bytes = encode(largest_set());
  for (auto _ : state) {
    auto payload = bytes.view().first(bytes.size() - 1);
    benchmark::DoNotOptimize(payload);
    benchmark::DoNotOptimize(checksum(payload));
  }
}
BENCHMARK(morap_checksum);

void morap_encode_program(benchmark::State& state) {
  Command command{CommandId::kProgram, largest_set()};
  for (auto _ : state) {
    benchmark::DoNotOptimize(command);
    benchmark::DoNotOptimize(encode(command));
  }
}
BENCHMARK(morap_encode_program);

void morap_decode_program(benchmark::State& state) {
  const auto bytes = encode(Command{CommandId::kProgram, largest_set()});
  for (auto _ : state) {
    auto data = bytes.view();
    benchmark::DoNotOptimize(data);
    benchmark::DoNotOptimize(decode_command(data));
  }
}
BENCHMARK(morap_decode_program);

void morap_decode_float_command(benchmark::State& state) {
  const auto bytes = encode(Command{CommandId::kPosition, 1.5F});
  for (auto _ : state) {
    auto data = bytes.view();
    benchmark::DoNotOptimize(data);
    benchmark::DoNotOptimize(decode_command(data));
  }
}
BENCHMARK(morap_decode_float_command);

}  // namespace
}  // namespace armjig::morap
