// SPDX-License-Identifier: Apache-2.0
// A whole PAROL6, board and gripper, with a host and somebody beside it: no frame is answered
// twice, answers are frames at times that never decrease, the gripper says what it can, and a copy
// of the arm goes on to the same bytes.
//
// Input: a byte of choices (what the fingers are like), then steps (fuzz/hosted.hpp).
#include "emulators/parol6/arm.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "fuzz/hosted.hpp"
#include "fuzz/parol6_input.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::fuzz::parol6_arm {
namespace {

using namespace parol6;
using namespace std::chrono_literals;
using emulation::Arm;
using emulation::ArmOptions;

constexpr auto kHands = std::to_array<std::string_view>(
    {"estop", "in1", "in2", "position.j1", "position.j4", "switch.j1", "switch.j2", "switch.j6",
     "between-fingers", "can.data", "can.frame", "power"});

GripperSetPoint set_point_from(Input& input) {
  const auto position = input.i16();
  const auto speed = input.i16();
  const auto current = input.i16();
  const auto command = input.u8();
  const auto mode = input.u8();
  return {.position = position,
          .speed = speed,
          .current = Milliamperes{current},
          .command = command,
          .mode = mode < 0xF0 ? static_cast<std::uint8_t>(mode % 3) : mode,
          .id = static_cast<std::uint8_t>(mode >> 4 & 1)};
}

std::vector<std::byte> frame_from(Input& input) {
  constexpr std::array kCodes{Command::kIdle,  Command::kJog,     Command::kGoTo,
                              Command::kHome,  Command::kDisable, Command::kClearError,
                              Command::kEnable};
  CommandFrame frame;
  const auto joints = draw_motion(input, kCodes, frame);
  frame.in_out = static_cast<std::uint8_t>(joints & io_flag::kOutputs);
  frame.gripper = set_point_from(input);
  const auto bytes = encode(frame);
  return {bytes.begin(), bytes.end()};
}

constexpr Surroundings kAround{kHands, frame_from, make_dissector};

Arm arm_from(std::uint8_t choices) {
  ArmOptions options;
  if ((choices & 1) != 0) options.gripper.reset();
  if (options.gripper) {
    options.gripper->is_calibrated = (choices & 2) == 0;
    options.gripper->plant.has_end_stops = (choices & 4) == 0;
    if ((choices & 8) != 0) options.gripper->plant.stop_opening = 40;
    options.gripper->node = choices >> 4 & 1;
  }
  if ((choices & 0x20) != 0) options.profile = emulation::kDocumentedBoard;
  return Arm{options};
}

void check_session(Input input) {
  const auto [arm, frames] = check_hosted(arm_from(input.u8()), {}, input, 3s, kAround);
  require(arm.sent().size() <= frames, "no frame is answered twice");
  for (const auto& sent : arm.sent()) {
    require(sent.bytes.size() == kTelemetryFrameSize, "each answer is one frame");
  }
}

}  // namespace
}  // namespace armjig::fuzz::parol6_arm

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::parol6_arm::check_session(
      armjig::fuzz::Input{std::as_bytes(std::span{data, size})});
  return 0;
}
