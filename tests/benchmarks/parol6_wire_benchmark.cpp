// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cstring>
#include <random>
#include <variant>
#include <vector>

#include "harness/wire/parol6/frame.hpp"
#include "harness/wire/parol6/splitter.hpp"

namespace armjig::parol6 {
namespace {

std::mt19937 random_bytes() { return std::mt19937{7}; }

std::vector<std::byte> clean_stream(std::size_t frames) {
  auto random = random_bytes();
  std::vector<std::byte> stream;
  for (std::size_t i = 0; i < frames; ++i) {
    TelemetryFrame frame;
    for (auto& position : frame.position) position = Steps{static_cast<int>(random() % 100000)};
    for (auto& speed : frame.speed) speed = StepsPerSecond{static_cast<int>(random() % 10000)};
    const auto bytes = encode(frame);
    stream.insert(stream.end(), bytes.begin(), bytes.end());
  }
  return stream;
}

std::vector<std::byte> noise(std::size_t size) {
  auto random = random_bytes();
  std::vector<std::byte> bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

void count_bytes(benchmark::State& state, std::size_t per_iteration) {
  state.SetBytesProcessed(static_cast<std::int64_t>(per_iteration) * state.iterations());
}

/// Bar: at most 25 ns.
void decode_telemetry_frame(benchmark::State& state) {
  const auto stream = clean_stream(64);
  std::size_t place = 0;
  for (auto _ : state) {
    const auto frame = Bytes{stream}.subspan(place).first<kTelemetryFrameSize>();
    benchmark::DoNotOptimize(decode_telemetry(body_of(frame)));
    place = (place + kTelemetryFrameSize) % stream.size();
  }
  count_bytes(state, kTelemetryFrameSize);
}
BENCHMARK(decode_telemetry_frame);

constexpr std::size_t kStreamFrames = 4096;

/// Baseline of the clean stream: the bytes copied.
void clean_stream_baseline_memcpy(benchmark::State& state) {
  const auto stream = clean_stream(kStreamFrames);
  std::vector<std::byte> copy(stream.size());
  for (auto _ : state) {
    std::memcpy(copy.data(), stream.data(), stream.size());
    benchmark::ClobberMemory();
  }
  count_bytes(state, stream.size());
}
BENCHMARK(clean_stream_baseline_memcpy);

/// Framing and decoding. Bar: 1 GB/s.
void clean_stream_split_and_decode(benchmark::State& state) {
  const auto stream = clean_stream(kStreamFrames);
  for (auto _ : state) {
    Splitter splitter{kTelemetryPayloadSize};
    Bytes rest{stream};
    while (!rest.empty()) {
      const auto step = splitter.step(rest);
      rest = rest.subspan(step.used);
      if (const auto* frame = std::get_if<Splitter::Frame>(&step.found)) {
        benchmark::DoNotOptimize(
            decode_telemetry(body_of(frame->bytes.first<kTelemetryFrameSize>())));
      }
    }
  }
  count_bytes(state, stream.size());
}
BENCHMARK(clean_stream_split_and_decode);

constexpr std::size_t kNoiseSize = std::size_t{1} << 20;

/// Baseline of the noise: memchr from start byte to start byte.
void noise_baseline_memchr(benchmark::State& state) {
  const auto bytes = noise(kNoiseSize);
  for (auto _ : state) {
    const auto* place = bytes.data();
    const auto* const end = place + bytes.size();
    std::size_t found = 0;
    while (const void* hit = std::memchr(place, 0xFF, static_cast<std::size_t>(end - place))) {
      place = static_cast<const std::byte*>(hit) + 1;
      ++found;
    }
    benchmark::DoNotOptimize(found);
  }
  count_bytes(state, bytes.size());
}
BENCHMARK(noise_baseline_memchr);

/// Bar: half the speed of the baseline.
void noise_split(benchmark::State& state) {
  const auto bytes = noise(kNoiseSize);
  for (auto _ : state) {
    Splitter splitter{kTelemetryPayloadSize};
    Bytes rest{bytes};
    while (!rest.empty()) {
      const auto step = splitter.step(rest);
      rest = rest.subspan(step.used);
      benchmark::DoNotOptimize(step.found.index());
    }
  }
  count_bytes(state, bytes.size());
}
BENCHMARK(noise_split);

}  // namespace
}  // namespace armjig::parol6
