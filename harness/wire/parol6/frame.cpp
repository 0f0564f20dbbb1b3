// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/frame.hpp"

#include <algorithm>

namespace armjig::parol6 {
namespace {

/// Bytes from which fields are taken off the front, in the order of the wire.
template <class Byte>
class Cursor {
 public:
  explicit Cursor(std::span<Byte> rest) noexcept : rest_{rest} {}

 protected:
  template <std::size_t Size>
  std::span<Byte, Size> take() noexcept {
    const auto field = rest_.template first<Size>();
    rest_ = rest_.subspan(Size);
    return field;
  }

 private:
  std::span<Byte> rest_;
};

class Reader : Cursor<const std::byte> {
 public:
  using Cursor::Cursor;

  std::int32_t i24() noexcept { return load_i24_be(take<3>()); }
  std::int16_t i16() noexcept { return load_i16_be(take<2>()); }
  std::uint16_t u16() noexcept { return load_u16_be(take<2>()); }
  std::uint8_t u8() noexcept { return std::to_integer<std::uint8_t>(take<1>()[0]); }

  /// What both frames begin with.
  template <class Frame>
  void joints(Frame& out) noexcept {
    for (auto& joint : out.position) joint.value = i24();
    for (auto& joint : out.speed) joint.value = i24();
  }
  /// What set-point and report of a gripper share.
  template <class Gripper>
  void fingers(Gripper& out) noexcept {
    out.position = i16();
    out.speed = i16();
    out.current.value = i16();
  }
};

/// The counterpart of `Reader`.
class Writer : Cursor<std::byte> {
 public:
  using Cursor::Cursor;

  void i24(std::int32_t v) noexcept { store_i24_be(take<3>(), v); }
  void i16(std::int16_t v) noexcept { store_i16_be(take<2>(), v); }
  void u16(std::uint16_t v) noexcept { store_u16_be(take<2>(), v); }
  void u8(std::uint8_t v) noexcept { take<1>()[0] = static_cast<std::byte>(v); }

  template <class Frame>
  void joints(const Frame& in) noexcept {
    for (const auto& joint : in.position) i24(joint.value);
    for (const auto& joint : in.speed) i24(joint.value);
  }
  template <class Gripper>
  void fingers(const Gripper& in) noexcept {
    i16(in.position);
    i16(in.speed);
    i16(in.current.value);
  }

  void header(std::size_t payload_size) noexcept {
    std::ranges::fill(take<kStartSize>(), kStartByte);
    u8(static_cast<std::uint8_t>(payload_size));
  }
  void end() noexcept { std::ranges::copy(kEndBytes, take<kEndBytes.size()>().begin()); }
};

}  // namespace

CommandFrame decode_command(std::span<const std::byte, kCommandBodySize> body) noexcept {
  CommandFrame frame;
  Reader in{body};
  in.joints(frame);
  frame.command = Command{in.u8()};
  frame.affected_joints = in.u8();
  frame.in_out = in.u8();
  frame.timeout = in.u8();
  in.fingers(frame.gripper);
  frame.gripper.command = in.u8();
  frame.gripper.mode = in.u8();
  frame.gripper.id = in.u8();
  frame.check = in.u8();
  return frame;
}

CommandBytes encode(const CommandFrame& frame) noexcept {
  CommandBytes bytes;
  Writer out{bytes};
  out.header(kCommandPayloadSize);
  out.joints(frame);
  out.u8(static_cast<std::uint8_t>(frame.command));
  out.u8(frame.affected_joints);
  out.u8(frame.in_out);
  out.u8(frame.timeout);
  out.fingers(frame.gripper);
  out.u8(frame.gripper.command);
  out.u8(frame.gripper.mode);
  out.u8(frame.gripper.id);
  out.u8(frame.check);
  out.end();
  return bytes;
}

TelemetryFrame decode_telemetry(std::span<const std::byte, kTelemetryBodySize> body) noexcept {
  TelemetryFrame frame;
  Reader in{body};
  in.joints(frame);
  frame.homed = in.u8();
  frame.io = in.u8();
  frame.temperature_error = in.u8();
  frame.position_error = in.u8();
  frame.timing = in.u16();
  frame.timeout_error = in.u8();
  frame.echo = Command{in.u8()};
  frame.gripper.id = in.u8();
  in.fingers(frame.gripper);
  frame.gripper.status = in.u8();
  frame.gripper.object_detection = in.u8();
  frame.check = in.u8();
  return frame;
}

TelemetryBytes encode(const TelemetryFrame& frame) noexcept {
  TelemetryBytes bytes;
  Writer out{bytes};
  out.header(kTelemetryPayloadSize);
  out.joints(frame);
  out.u8(frame.homed);
  out.u8(frame.io);
  out.u8(frame.temperature_error);
  out.u8(frame.position_error);
  out.u16(frame.timing);
  out.u8(frame.timeout_error);
  out.u8(static_cast<std::uint8_t>(frame.echo));
  out.u8(frame.gripper.id);
  out.fingers(frame.gripper);
  out.u8(frame.gripper.status);
  out.u8(frame.gripper.object_detection);
  out.u8(frame.check);
  out.end();
  return bytes;
}

}  // namespace armjig::parol6
