// SPDX-License-Identifier: Apache-2.0
// One PAROL6 frame each way, out of any bytes: what decodes encodes to the bytes that it was, and
// what encodes decodes to the values that it was.
//
// Input: a body of a command, of which what is missing is 0, and the same bytes as one of
// telemetry.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz/require.hpp"
#include "harness/wire/parol6/fields.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::fuzz::parol6_frame {
namespace {

using namespace parol6;

template <std::size_t size>
std::array<std::byte, size> filled(Bytes data) {
  std::array<std::byte, size> body{};
  std::copy_n(data.begin(), std::min(size, data.size()), body.begin());
  return body;
}

/// Each bit of a body means something.
template <std::size_t size, class Frame, class Decode>
void check_bit(std::array<std::byte, size> body, std::size_t bit, const Frame& frame,
               Decode decode) {
  body[bit / 8 % size] ^= std::byte{1} << bit % 8;
  require(!(decode(body) == frame), "other bytes are another frame");
}

void check_readings(const TelemetryFrame& frame) {
  const auto all = is_homed(frame);
  bool each = true;
  for (std::size_t joint = 0; joint < kJointCount; ++joint) each = each && is_homed(frame, joint);
  require(all == each, "an arm is homed if each joint is");
  auto other = frame;
  other.io ^= io_flag::kEstopReleased;
  require(is_estop_pressed(other) != is_estop_pressed(frame), "its bit says it of the stop");
  require(object_of(frame.gripper.status) <= GripperObject::kAtPosition, "there are four of them");
  require(interval_of(frame.timing) < std::chrono::milliseconds{94}, "the timing field wraps");
}

void check_command(const CommandFrame& frame) {
  const bool is_homing_or_demo = frame.command == Command::kHome || frame.command == Command::kDemo;
  require(!moves(frame.command) || ends_homing(frame.command) != is_homing_or_demo,
          "what moves joints ends a homing, or is one");
  require(!name_of(frame.command).empty(), "a code has a name, or a number");
}

void check_frames(Bytes data) {
  const auto asked = filled<kCommandBodySize>(data);
  const auto command = decode_command(asked);
  const auto command_bytes = encode(command);
  require(are_equal(body_of(command_bytes), asked), "encode(decode(x)) == x, a command");
  require(decode_command(body_of(command_bytes)) == command, "decode(encode(x)) == x, a command");
  const auto said = filled<kTelemetryBodySize>(data);
  const auto telemetry = decode_telemetry(said);
  const auto telemetry_bytes = encode(telemetry);
  require(are_equal(body_of(telemetry_bytes), said), "encode(decode(x)) == x, telemetry");
  require(decode_telemetry(body_of(telemetry_bytes)) == telemetry,
          "decode(encode(x)) == x, telemetry");
  const auto bit = data.empty() ? 0 : 8 * data.size() + std::to_integer<std::size_t>(data.back());
  check_bit(asked, bit, command, decode_command);
  check_bit(said, bit, telemetry, decode_telemetry);
  check_command(command);
  check_readings(telemetry);
}

}  // namespace
}  // namespace armjig::fuzz::parol6_frame

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::parol6_frame::check_frames(std::as_bytes(std::span{data, size}));
  return 0;
}
