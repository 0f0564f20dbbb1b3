// SPDX-License-Identifier: Apache-2.0
// The host side of a board on whatever comes from the other end: it never says what was not asked
// for, least of all motion while the emergency stop is latched, and it loses count of no frame.
//
// Input: operations, each one byte and its arguments.
#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz/input.hpp"
#include "fuzz/require.hpp"
#include "harness/drive/parol6/drive.hpp"

namespace armjig::fuzz::board_drive {
namespace {

using namespace std::chrono_literals;
using parol6::Command;
using parol6::drive::Drive;

constexpr int kMostOperations = 400;

class Bench {
 public:
  void operate(Input& input) {
    const auto what = input.u8();
    switch (what % 10) {
      case 0:
      case 1:
        return tick(kPeriods[what / 10 % kPeriods.size()]);
      case 2:
        return drive_.receive(now_, input.bytes(input.u8()));
      case 3:
      case 4:
      case 5:
        return answer(input);
      case 6:
        return request(input);
      case 7:
        return drive_.set_outputs(input.u8());
      case 8:
        return drive_.set_gripper({.position = input.i16(), .mode = input.u8()});
      default:
        now_ += std::chrono::microseconds{input.u8()};
    }
  }

 private:
  static constexpr std::array<Duration, 4> kPeriods{parol6::kFramePeriod, 1ms, 600ms, 0ms};

  void tick(Duration period) {
    now_ += period;
    const auto bytes = drive_.tick(now_);
    const auto frame = parol6::decode_command(parol6::body_of(bytes));
    require(encode(frame) == bytes, "what leaves is a frame");
    if (drive_.is_latched()) {
      require(frame.command == Command::kDisable, "nothing but disable leaves while it is latched");
    }
    const auto& counts = drive_.statistics();
    require(counts.answered + counts.lost + drive_.outstanding() == counts.sent,
            "each frame is answered, lost, or waited for");
    for (const auto& event : drive_.take_events()) {
      require(event.time >= told_ && event.time <= now_, "events have times in order");
      require(!event.joint || *event.joint < parol6::kJointCount, "a joint that there is");
      require(!describe(event).empty(), "an event has words");
      told_ = event.time;
    }
  }

  /// A whole frame of telemetry, with numbers that no board has.
  void answer(Input& input) {
    auto frame = drive_.telemetry().value_or(parol6::TelemetryFrame{});
    for (auto joints = input.u8(); joints != 0; joints &= static_cast<std::uint8_t>(joints - 1)) {
      const auto j = static_cast<std::size_t>(std::countr_zero(joints)) % parol6::kJointCount;
      frame.position[j] = Steps{input.i16() * 256};
      frame.speed[j] = StepsPerSecond{input.i16() * 256};
    }
    frame.homed = input.u8();
    frame.io = input.u8();
    frame.echo = Command{input.u8()};
    drive_.receive(now_, encode(frame));
  }

  void request(Input& input) {
    const auto what = input.u8();
    const bool was_latched = drive_.is_latched();
    parol6::JointSpeeds speeds{};
    parol6::JointSteps goal{};
    for (std::size_t j = 0; j < parol6::kJointCount; ++j) {
      speeds[j] = StepsPerSecond{input.i16()};
      goal[j] = Steps{input.i16()};
    }
    Result<void> asked;
    switch (what % 7) {
      case 0:
        asked = drive_.jog(speeds);
        break;
      case 1:
        asked = drive_.go_to(goal, speeds);
        break;
      case 2:
        asked = drive_.home();
        break;
      case 3:
        asked = drive_.clear_error();
        break;
      case 4:
        (void)drive_.enable();
        return;
      case 5:
        return drive_.disable();
      default:
        return drive_.idle();
    }
    require(asked.has_value() != was_latched, "refused while it is latched, and only then");
  }

  Drive drive_;
  Instant now_{};
  Instant told_{};
};

}  // namespace
}  // namespace armjig::fuzz::board_drive

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace armjig::fuzz;
  Input input{std::as_bytes(std::span{data, size})};
  board_drive::Bench bench;
  for (int i = 0; i < board_drive::kMostOperations && !input.is_empty(); ++i) bench.operate(input);
  return 0;
}
