// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "harness/capture/capture.hpp"
#include "harness/capture/message_json.hpp"
#include "harness/wire/append_text.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

/// A million exchanges with an arm that moves, each frame a record, in a file that is deleted.
class RecordedArm {
 public:
  static constexpr std::size_t kExchanges = 1'000'000;

  RecordedArm() : path_{std::filesystem::temp_directory_path() / "armjig-benchmark.pcapng"} {
    const auto writer = make_capture_writer(CaptureFormat::kPcapng);
    const CaptureLink link{"parol6", "parol6", LinkKind::kStream};
    std::ofstream file{path_, std::ios::binary};
    std::string text;
    (void)writer->begin({R"({"format":"golden-trace/1","device":"parol6"})", "parol6", 0}, text);
    CaptureRecord record;
    record.link = &link;
    for (std::size_t i = 0; i < kExchanges; ++i) {
      parol6::CommandFrame command;
      parol6::TelemetryFrame telemetry;
      for (std::size_t joint = 0; joint < command.position.size(); ++joint) {
        const auto steps = Steps{static_cast<int>(i * (joint + 3) % 50'000)};
        command.position[joint] = telemetry.position[joint] = steps;
        telemetry.speed[joint] = StepsPerSecond{static_cast<int>(1000 + 700 * joint)};
      }
      const auto add = [&](Direction direction, Duration since, Bytes bytes) {
        record.direction = direction;
        record.time = at(i * 10ms + since);
        record.bytes = bytes;
        (void)writer->add(record, {}, text);
      };
      add(Direction::kToDevice, {}, parol6::encode(command));
      add(Direction::kFromDevice, 300us, parol6::encode(telemetry));
      file << text;
      size_ += text.size();
      text.clear();
    }
  }
  RecordedArm(const RecordedArm&) = delete;
  RecordedArm& operator=(const RecordedArm&) = delete;
  ~RecordedArm() { std::filesystem::remove(path_); }

  [[nodiscard]] UserFile open() const { return *UserFile::open(path_.string()); }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  template <class Take>
  void each_message(Take take) const {
    const auto reader = *CaptureReader::open(open(), path_.string());
    const auto dissector = parol6::make_dissector();
    std::vector<Message> messages;
    CaptureRecord record;
    while (*reader->next(record)) {
      dissector->feed(record.direction, record.time, record.bytes, messages);
      for (const auto& message : messages) take(message);
      messages.clear();
    }
  }

 private:
  std::filesystem::path path_;
  std::size_t size_{};
};

const RecordedArm& recorded_arm() {
  static const RecordedArm kArm;
  return kArm;
}

void count_all(benchmark::State& state, const RecordedArm& arm) {
  state.SetBytesProcessed(static_cast<std::int64_t>(arm.size()) * state.iterations());
  state.SetItemsProcessed(static_cast<std::int64_t>(2 * RecordedArm::kExchanges) *
                          state.iterations());
}

/// Baseline: the same file read in pieces.
void recording_baseline_read(benchmark::State& state) {
  const auto& arm = recorded_arm();
  std::vector<std::byte> piece(std::size_t{256} << 10U);
  for (auto _ : state) {
    auto file = arm.open();
    while (*file.read(piece) > 0) benchmark::ClobberMemory();
  }
  count_all(state, arm);
}
BENCHMARK(recording_baseline_read)->Unit(benchmark::kMillisecond);

/// A pcapng file through dissector and splitter, to values. Bar: 0.2 of the baseline.
void recording_to_values(benchmark::State& state) {
  const auto& arm = recorded_arm();
  for (auto _ : state) {
    arm.each_message([](const Message& message) {
      if (message.raw.size() == parol6::kTelemetryFrameSize) {
        const auto frame = Bytes{message.raw}.first<parol6::kTelemetryFrameSize>();
        benchmark::DoNotOptimize(parol6::decode_telemetry(parol6::body_of(frame)));
      } else {
        const auto frame = Bytes{message.raw}.first<parol6::kCommandFrameSize>();
        benchmark::DoNotOptimize(parol6::decode_command(parol6::body_of(frame)));
      }
    });
  }
  count_all(state, arm);
}
BENCHMARK(recording_to_values)->Unit(benchmark::kMillisecond);

/// The text of `decode`. Bar: 500,000 frames in a second.
void recording_to_text(benchmark::State& state) {
  const auto& arm = recorded_arm();
  std::string text;
  for (auto _ : state) {
    arm.each_message([&text](const Message& message) {
      text.clear();
      append_line(text, message);
      benchmark::DoNotOptimize(text.data());
    });
  }
  count_all(state, arm);
}
BENCHMARK(recording_to_text)->Unit(benchmark::kMillisecond);

/// The JSON of `decode`. Bar: 200,000 frames in a second.
void recording_to_json(benchmark::State& state) {
  const auto& arm = recorded_arm();
  std::string text;
  for (auto _ : state) {
    arm.each_message([&text](const Message& message) {
      text.clear();
      append_json(text, message);
      benchmark::DoNotOptimize(text.data());
    });
  }
  count_all(state, arm);
}
BENCHMARK(recording_to_json)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace armjig
