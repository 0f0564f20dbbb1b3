// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/dissector.hpp"
#include "harness/wire/field.hpp"

/// Modbus RTU as far as a gripper needs it. Sources, both public and from modbus.org: [A] is
/// "MODBUS Application Protocol Specification V1.1b3", [S] "MODBUS over Serial Line Specification
/// and Implementation Guide V1.02".
namespace gripper {

using Frame = std::vector<std::byte>;  ///< from the address on; with or without its CRC, as said

enum class Function : std::uint8_t { kRead = 3, kWrite = 6, kWriteMany = 16 };
enum class Exception : std::uint8_t { kNone, kFunction, kAddress, kValue, kFailure };
constexpr std::byte kExceptionBit{0x80};

constexpr std::uint8_t kUnit = 1;        ///< the address of the gripper
constexpr unsigned kUsualBaud = 19'200;  ///< that of [S] 3.2, with even parity
constexpr std::uint8_t kBroadcast = 0;
constexpr std::size_t kMostFrame = 256;      ///< with CRC ([A] 4.1)
constexpr std::uint16_t kMostRead = 125;     ///< registers in one request ([A] 6.3)
constexpr std::uint16_t kMostWritten = 123;  ///< ([A] 6.12)

/// The holding registers of the gripper; writable are those up to `kForce`. Lengths are in tenths
/// of a millimetre between the jaws.
enum Register : std::uint16_t {
  kControl,  ///< 0 stops; anything else moves to `kTarget`
  kTarget,
  kSpeed,
  kForce,
  kStatus,
  kPosition,
  kGripForce,  ///< what the jaws exert now
  kModel,
  kRegisters
};
constexpr unsigned kWidest = 1000;         ///< the jaws, open
constexpr unsigned kModelNumber = 0x4752;  ///< what `kModel` is
enum class Status : std::uint16_t { kStopped, kMoving, kArrived, kHolding };

[[nodiscard]] std::uint16_t crc16(armjig::Bytes bytes) noexcept;
void append(Frame& frame, unsigned word);  ///< the high byte first ([A] 4.2)
void append_crc(Frame& frame);             ///< the low byte first ([S] 2.5.1.2)
[[nodiscard]] bool has_good_crc(armjig::Bytes frame) noexcept;

// Requests with their CRC; `unit` is the address of the device.
[[nodiscard]] Frame request(std::uint8_t unit, std::initializer_list<unsigned> bytes);
[[nodiscard]] Frame read_request(std::uint8_t unit, unsigned first, unsigned count);
[[nodiscard]] Frame write_request(std::uint8_t unit, unsigned place, unsigned value);
[[nodiscard]] Frame write_many_request(std::uint8_t unit, unsigned first,
                                       std::initializer_list<unsigned> values);

/// The size with CRC of the frame that begins so: 0 if none of ours does, nothing if more bytes are
/// needed to tell.
[[nodiscard]] std::optional<std::size_t> size_of(armjig::Direction direction,
                                                 armjig::Bytes begin) noexcept;

/// The silences of a line ([S] 2.5.1.1). A character is always 11 bits ([S] 2.5.1).
struct Silence {
  armjig::Duration character{};
  armjig::Duration most_within{};    ///< t1.5: longer ones spoil the frame that they are in
  armjig::Duration least_between{};  ///< t3.5: ends a frame

  [[nodiscard]] static Silence at(unsigned baud) noexcept;
};

/// Cuts characters into frames, by silence alone.
class Receiver {
 public:
  explicit Receiver(const Silence& silence) noexcept : silence_{silence} {}

  /// Takes a character that ended at `time`. Requires that `take` was called for that time.
  void receive(armjig::Instant time, std::byte byte);
  /// When the frame is over if nothing more comes: a character that began in time has ended then.
  [[nodiscard]] std::optional<armjig::Instant> end() const noexcept;
  /// The frame with its CRC, if one is over by `time`; an empty one if it is spoilt.
  [[nodiscard]] std::optional<Frame> take(armjig::Instant time);
  /// What has come of the frame so far.
  [[nodiscard]] armjig::Bytes pending() const noexcept { return frame_; }

 private:
  Silence silence_;
  Frame frame_;
  armjig::Instant last_{};
  bool is_spoilt_ = false;
};

/// Of the answer to a request for all registers, without its CRC.
[[nodiscard]] std::span<const armjig::Field> block_fields() noexcept;

/// Finds frames by their form and CRC, not by silence: bytes from a file have no times, and those
/// that came through an operating system have wrong ones.
[[nodiscard]] std::unique_ptr<armjig::Dissector> make_dissector();

}  // namespace gripper
