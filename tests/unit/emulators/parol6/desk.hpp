// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <utility>
#include <variant>
#include <vector>

#include "emulators/parol6/board.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig::parol6::emulation {

/// A command frame for tests that are about what the board does with it.
[[nodiscard]] inline CommandFrame command(Command code,
                                          std::array<std::int32_t, kJointCount> speeds = {}) {
  CommandFrame frame;
  frame.command = code;
  for (std::size_t j = 0; j < kJointCount; ++j) frame.speed[j] = StepsPerSecond{speeds[j]};
  return frame;
}

[[nodiscard]] inline CommandFrame go_to(std::array<std::int32_t, kJointCount> positions,
                                        std::array<std::int32_t, kJointCount> speeds = {}) {
  auto frame = command(Command::kGoTo, speeds);
  for (std::size_t j = 0; j < kJointCount; ++j) frame.position[j] = Steps{positions[j]};
  return frame;
}

[[nodiscard]] inline std::array<std::int32_t, kJointCount> counters(const Board& board) {
  std::array<std::int32_t, kJointCount> counters{};
  for (std::size_t j = 0; j < kJointCount; ++j) counters[j] = board.joints()[j].position().value;
  return counters;
}

[[nodiscard]] inline std::array<float, kJointCount> speeds(const Board& board) {
  std::array<float, kJointCount> speeds{};
  for (std::size_t j = 0; j < kJointCount; ++j) speeds[j] = board.joints()[j].stepper.speed().value;
  return speeds;
}

/// A board and somebody at the other end of its cable. `now` goes forward only.
class Desk {
 public:
  explicit Desk(Board new_board) : board{std::move(new_board)} {}

  /// Sends bytes now and waits for the pass that reads them. The telemetry that came.
  std::vector<test::ByteVector> send(const test::ByteVector& bytes) {
    board.receive(at(now), bytes);
    return take();
  }
  /// The same with one frame, which must have one answer.
  TelemetryFrame send(const CommandFrame& frame) {
    const auto answers = send(test::as_vector(encode(frame)));
    EXPECT_EQ(answers.size(), 1U);
    if (answers.size() != 1) return {};
    return decode_telemetry(body_of(Bytes{answers[0]}.first<kTelemetryFrameSize>()));
  }

  /// Lets time pass up to a pass at its end, which can still read what is sent then.
  void wait(Duration duration) {
    now += duration;
    board.advance_to(at(now - Duration{1}));
  }
  /// Lets time pass, a pass at its end included.
  void run(Duration duration) {
    now += duration;
    board.advance_to(at(now));
  }
  /// Repeats a frame every 10 ms. The last answer.
  TelemetryFrame hold(const CommandFrame& frame, Duration duration) {
    TelemetryFrame answer;
    for (const auto end = now + duration; now < end; wait(std::chrono::milliseconds{10})) {
      answer = send(frame);
    }
    return answer;
  }

  Board board;
  Duration now{};
  std::vector<CanFrame> can;  ///< all that the board sent there

 private:
  std::vector<test::ByteVector> take() {
    while (const auto event = board.next_event()) board.advance_to(*event);
    std::vector<test::ByteVector> answers;
    for (const auto& emission : board.sent()) {
      if (const auto* frame = std::get_if<CanFrame>(&emission.what)) {
        can.push_back(*frame);
      } else {
        answers.push_back(test::as_vector(std::get<TelemetryBytes>(emission.what)));
      }
      now = std::max(now, emission.time.time_since_epoch());
    }
    board.clear_sent();
    return answers;
  }
};

/// The hidden start of the reference's homing timeline, section 6.6.
[[nodiscard]] inline Board board_with_pass(std::uint32_t pass_us) {
  return Board{standard_plant(), BoardTiming{.pass_period = std::chrono::microseconds{pass_us}}};
}

}  // namespace armjig::parol6::emulation
