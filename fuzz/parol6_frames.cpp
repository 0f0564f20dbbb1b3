// SPDX-License-Identifier: Apache-2.0
// The emulated board alone with a host that sends 20 frames at 100 Hz: each is answered once, in
// time, times never decrease, joints go no faster than a step in each pass, and a copy of the board
// goes on to the same bytes.
//
// Input: when a copy is made (0: never), then the frames; what is missing of them is 0, and the
// last one is said again.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <variant>

#include "emulators/parol6/board.hpp"
#include "fuzz/input.hpp"
#include "fuzz/parol6_input.hpp"
#include "fuzz/require.hpp"

namespace armjig::fuzz::parol6_frames {
namespace {

using namespace parol6;
using namespace std::chrono_literals;
using emulation::Board;
using emulation::Emission;

constexpr std::size_t kFrames = 20;
constexpr Duration kPeriod = 10ms;
constexpr auto kPass = 20us;

CommandFrame frame_from(Input& input, const CommandFrame& before) {
  constexpr std::array kCodes{Command::kIdle,    Command::kJog,       Command::kGoTo,
                              Command::kHome,    Command::kDemo,      Command::kEnable,
                              Command::kDisable, Command::kClearError};
  if (input.is_empty()) return before;
  CommandFrame frame;
  const auto joints = draw_motion(input, kCodes, frame);
  if ((joints & 0x40) != 0) frame.in_out = input.u8();
  return frame;
}

/// Homing counts steps, so it sets positions, too.
bool may_leap(const CommandFrame& frame) { return frame.command == Command::kHome; }

void check_answers(std::span<const Emission> sent, bool has_leapt) {
  constexpr std::int64_t kMostSteps = kPeriod / kPass + 2;
  std::size_t answers = 0;
  Instant last{};
  std::optional<TelemetryFrame> before;
  for (const auto& one : sent) {
    require(one.time >= last, "times never decrease");
    last = one.time;
    const auto* const bytes = std::get_if<TelemetryBytes>(&one.what);
    if (bytes == nullptr) continue;
    require(one.time < at(kPeriod * static_cast<std::int64_t>(answers + 1)),
            "each frame is answered before the next");
    ++answers;
    const auto frame = decode_telemetry(body_of(*bytes));
    require(are_equal(encode(frame), *bytes), "each answer is a frame");
    for (std::size_t j = 0; before && !has_leapt && j < kJointCount; ++j) {
      const auto steps = std::int64_t{frame.position[j].value} - before->position[j].value;
      require(std::abs(steps) <= kMostSteps, "a joint makes no more than a step in each pass");
    }
    before = frame;
  }
  require(answers == kFrames, "each frame is answered once");
}

void check_session(Input input) {
  static const Board kFresh{emulation::standard_plant(),
                            emulation::BoardTiming{.pass_period = kPass}};
  const std::size_t copied_at = input.u8();
  std::array<CommandBytes, kFrames> frames{};
  CommandFrame frame;
  bool has_leapt = false;
  for (auto& bytes : frames) {
    frame = frame_from(input, frame);
    // It sleeps in the middle of a pass during the demonstration, and answers late.
    if (frame.command == Command::kDemo) frame.command = Command::kIdle;
    has_leapt |= may_leap(frame);
    bytes = encode(frame);
  }
  auto board = kFresh;
  std::optional<Board> copy;
  const auto send = [&](Board& to, std::size_t i) {
    const auto now = at(kPeriod * static_cast<std::int64_t>(i));
    to.receive(now, frames[i]);
    to.advance_to(now + kPeriod - 1ns);
  };
  for (std::size_t i = 0; i < kFrames; ++i) {
    if (i > 0 && i == copied_at) copy = board;
    send(board, i);
  }
  check_answers(board.sent(), has_leapt);
  if (!copy) return;
  for (auto i = copied_at; i < kFrames; ++i) send(*copy, i);
  const auto is_same = [](const Emission& one, const Emission& other) {
    return one.time == other.time && one.what == other.what;
  };
  require(std::ranges::equal(board.sent(), copy->sent(), is_same),
          "a copy goes on to the same bytes");
}

}  // namespace
}  // namespace armjig::fuzz::parol6_frames

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::parol6_frames::check_session(
      armjig::fuzz::Input{std::as_bytes(std::span{data, size})});
  return 0;
}
