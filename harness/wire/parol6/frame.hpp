// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "harness/core/bytes.hpp"
#include "harness/core/quantity.hpp"
#include "harness/core/time.hpp"

/// The serial protocol of the PAROL6 control board (docs/spec/parol6.md). Every frame is
/// `FF FF FF LEN payload[LEN]`; the payload ends with a check byte and `01 02`. Numbers are
/// big-endian. The host sends commands, the board answers each accepted one with telemetry.
namespace armjig::parol6 {

inline constexpr std::size_t kJointCount = 6;
using JointSteps = std::array<Steps, kJointCount>;
using JointSpeeds = std::array<StepsPerSecond, kJointCount>;

inline constexpr std::byte kStartByte{0xFF};
inline constexpr std::size_t kStartSize = 3;
inline constexpr std::size_t kHeaderSize = 4;        ///< start bytes and length byte
inline constexpr std::size_t kLongestPayload = 255;  ///< that a length byte can say
inline constexpr std::array kEndBytes{std::byte{0x01}, std::byte{0x02}};

inline constexpr std::size_t kCommandPayloadSize = 52;
inline constexpr std::size_t kCommandFrameSize = kHeaderSize + kCommandPayloadSize;
/// What the board unpacks: everything in front of the end bytes.
inline constexpr std::size_t kCommandBodySize = kCommandPayloadSize - kEndBytes.size();

inline constexpr std::size_t kTelemetryPayloadSize = 56;
inline constexpr std::size_t kTelemetryFrameSize = kHeaderSize + kTelemetryPayloadSize;
inline constexpr std::size_t kTelemetryBodySize = kTelemetryPayloadSize - kEndBytes.size();

/// Positions and speeds have 24 bits; the lowest is one less than minus this.
inline constexpr std::int32_t kMostSteps = 8'388'607;

/// The check byte is a constant: the board and its document have `kCheckBoard`, the host programs
/// send `kCheckHost`. No polynomial exists.
inline constexpr std::uint8_t kCheckBoard = 0xD4;
inline constexpr std::uint8_t kCheckHost = 0xE4;

/// Hosts send 100 frames a second.
inline constexpr Duration kFramePeriod = std::chrono::milliseconds{10};

/// Of the timer behind `TelemetryFrame::timing`, which wraps at 16 bits: 90 MHz / 128.
inline constexpr std::int64_t kTicksPerSecond = 703'125;

/// Decimal on the wire although the document writes them with a 0x prefix. Any byte is possible;
/// the ones without a name do nothing.
enum class Command : std::uint8_t {
  kDemo = 69,  ///< undocumented two-leg repeatability run
  kHome = 100,
  kEnable = 101,
  kDisable = 102,
  kClearError = 103,
  kJog = 123,   ///< run at the commanded speeds
  kGoTo = 156,  ///< follow the commanded positions and speeds
  kIdle = 255,
};

/// Flag bytes have their first element in bit 7.
[[nodiscard]] constexpr std::uint8_t flag(std::size_t element) noexcept {
  return static_cast<std::uint8_t>(0x80U >> element);
}

namespace io_flag {
inline constexpr std::uint8_t kIn1 = flag(0);
inline constexpr std::uint8_t kIn2 = flag(1);
inline constexpr std::uint8_t kOut1 = flag(2);
inline constexpr std::uint8_t kOut2 = flag(3);
inline constexpr std::uint8_t kOutputs = kOut1 | kOut2;
inline constexpr std::uint8_t kEstopReleased = flag(4);
inline constexpr std::uint8_t kSpare = 0x07;  ///< always set in telemetry
}  // namespace io_flag

/// What the gripper is asked to do; the low bits of the command byte have no meaning.
struct GripperSetPoint {
  std::int16_t position{};  ///< 0 open to 255 closed; the board passes on the low byte
  std::int16_t speed{};     ///< 0 to 255; the board passes on the low byte
  Milliamperes current{};
  std::uint8_t command{};  ///< `gripper_command` flags
  std::uint8_t mode{};     ///< `gripper_mode`
  std::uint8_t id{};       ///< CAN node

  friend bool operator==(const GripperSetPoint&, const GripperSetPoint&) = default;
};

/// The highest current that the document allows.
inline constexpr Milliamperes kMaxGripperCurrent{1300};

namespace gripper_mode {
inline constexpr std::uint8_t kMove = 0;
inline constexpr std::uint8_t kCalibrate = 1;
inline constexpr std::uint8_t kClearError = 2;
}  // namespace gripper_mode

namespace gripper_command {
inline constexpr std::uint8_t kActivate = flag(0);
inline constexpr std::uint8_t kGoTo = flag(1);
inline constexpr std::uint8_t kEstop = flag(2);
inline constexpr std::uint8_t kReleaseDirection = flag(3);
}  // namespace gripper_command

namespace gripper_status {
inline constexpr std::uint8_t kActivated = flag(0);
inline constexpr std::uint8_t kGoTo = flag(1);
inline constexpr std::uint8_t kObjectLow = flag(2);   ///< the object code's bit 0 comes first
inline constexpr std::uint8_t kObjectHigh = flag(3);  ///< its bit 1
inline constexpr std::uint8_t kTemperatureError = flag(4);
inline constexpr std::uint8_t kTimeoutError = flag(5);
inline constexpr std::uint8_t kEstopError = flag(6);
inline constexpr std::uint8_t kCalibrated = flag(7);
}  // namespace gripper_status

/// One frame from host to board.
struct CommandFrame {
  std::array<Steps, kJointCount> position{};
  std::array<StepsPerSecond, kJointCount> speed{};
  Command command{};
  std::uint8_t affected_joints{};
  std::uint8_t in_out{};   ///< the board reads `kOutputs`
  std::uint8_t timeout{};  ///< milliseconds, 0 off; the shipped board ignores it
  GripperSetPoint gripper{};
  std::uint8_t check = kCheckBoard;

  friend bool operator==(const CommandFrame&, const CommandFrame&) = default;
};

/// What the board says of the gripper.
struct GripperReport {
  std::uint8_t id{};
  std::int16_t position{};
  std::int16_t speed{};
  Milliamperes current{};
  std::uint8_t status{};  ///< `gripper_status` flags
  std::uint8_t object_detection{};

  friend bool operator==(const GripperReport&, const GripperReport&) = default;
};

/// One frame from board to host.
struct TelemetryFrame {
  std::array<Steps, kJointCount> position{};
  std::array<StepsPerSecond, kJointCount> speed{};
  std::uint8_t homed{};  ///< `flag(joint)`, the two spare bits set
  std::uint8_t io{};     ///< `io_flag`
  std::uint8_t temperature_error{};
  std::uint8_t position_error{};
  std::uint16_t timing{};  ///< `kTicksPerSecond` since the frame before, modulo 65536
  std::uint8_t timeout_error{};
  Command echo{};  ///< of the frame being answered; the document calls it xtr2
  GripperReport gripper{};
  std::uint8_t check = kCheckBoard;

  friend bool operator==(const TelemetryFrame&, const TelemetryFrame&) = default;
};

using CommandBytes = std::array<std::byte, kCommandFrameSize>;
using TelemetryBytes = std::array<std::byte, kTelemetryFrameSize>;

/// Decoding takes the payload without its end bytes, which framing has judged already. It cannot
/// fail: any bytes there mean something.
[[nodiscard]] CommandFrame decode_command(
    std::span<const std::byte, kCommandBodySize> body) noexcept;
[[nodiscard]] TelemetryFrame decode_telemetry(
    std::span<const std::byte, kTelemetryBodySize> body) noexcept;

/// The whole frame. `encode(decode(x)) == x` for every frame of nominal length; values that do not
/// fit in 24 bits lose their upper ones, as in the board.
[[nodiscard]] CommandBytes encode(const CommandFrame& frame) noexcept;
[[nodiscard]] TelemetryBytes encode(const TelemetryFrame& frame) noexcept;

/// The part of a whole frame that decoding takes.
[[nodiscard]] constexpr auto body_of(std::span<const std::byte, kCommandFrameSize> frame) noexcept {
  return frame.subspan<kHeaderSize, kCommandBodySize>();
}
[[nodiscard]] constexpr auto body_of(
    std::span<const std::byte, kTelemetryFrameSize> frame) noexcept {
  return frame.subspan<kHeaderSize, kTelemetryBodySize>();
}

}  // namespace armjig::parol6
