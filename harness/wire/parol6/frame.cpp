// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/frame.hpp"

#include <algorithm>

namespace armjig::parol6 {
namespace {

/// Takes fields off the front of a body, in the order of the wire.
class Reader {
 public:
  explicit Reader(Bytes rest) noexcept : rest_{rest} {}

  std::int32_t i24() noexcept { return load_i24_be(take<3>()); }
  std::int16_t i16() noexcept { return load_i16_be(take<2>()); }
  std::uint16_t u16() noexcept { return load_u16_be(take<2>()); }
  std::uint8_t u8() noexcept { return std::to_integer<std::uint8_t>(take<1>()[0]); }

  template <class Joints>
  void joints(Joints& out) noexcept {
    for (auto& joint : out) joint.value = i24();
  }

 private:
  template <std::size_t Size>
  std::span<const std::byte, Size> take() noexcept {
    const auto field = rest_.first<Size>();
    rest_ = rest_.subspan(Size);
    return field;
  }

  Bytes rest_;
};

/// Puts fields behind each other; the counterpart of `Reader`.
class Writer {
 public:
  explicit Writer(std::span<std::byte> rest) noexcept : rest_{rest} {}

  void i24(std::int32_t v) noexcept { store_i24_be(take<3>(), v); }
  void i16(std::int16_t v) noexcept { store_i16_be(take<2>(), v); }
  void u16(std::uint16_t v) noexcept { store_u16_be(take<2>(), v); }
  void u8(std::uint8_t v) noexcept { take<1>()[0] = static_cast<std::byte>(v); }

  template <class Joints>
  void joints(const Joints& in) noexcept {
    for (const auto& joint : in) i24(joint.value);
  }

  void header(std::size_t payload_size) noexcept {
    std::ranges::fill(take<kStartSize>(), kStartByte);
    u8(static_cast<std::uint8_t>(payload_size));
  }
  void end() noexcept { std::ranges::copy(kEndBytes, take<kEndBytes.size()>().begin()); }

 private:
  template <std::size_t Size>
  std::span<std::byte, Size> take() noexcept {
    const auto field = rest_.first<Size>();
    rest_ = rest_.subspan(Size);
    return field;
  }

  std::span<std::byte> rest_;
};

}  // namespace

CommandFrame decode_command(std::span<const std::byte, kCommandBodySize> body) noexcept {
  CommandFrame frame;
  Reader in{body};
  in.joints(frame.position);
  in.joints(frame.speed);
  frame.command = Command{in.u8()};
  frame.affected_joints = in.u8();
  frame.in_out = in.u8();
  frame.timeout = in.u8();
  frame.gripper.position = in.i16();
  frame.gripper.speed = in.i16();
  frame.gripper.current = Milliamperes{in.i16()};
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
  out.joints(frame.position);
  out.joints(frame.speed);
  out.u8(static_cast<std::uint8_t>(frame.command));
  out.u8(frame.affected_joints);
  out.u8(frame.in_out);
  out.u8(frame.timeout);
  out.i16(frame.gripper.position);
  out.i16(frame.gripper.speed);
  out.i16(frame.gripper.current.value);
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
  in.joints(frame.position);
  in.joints(frame.speed);
  frame.homed = in.u8();
  frame.io = in.u8();
  frame.temperature_error = in.u8();
  frame.position_error = in.u8();
  frame.timing = in.u16();
  frame.timeout_error = in.u8();
  frame.echo = Command{in.u8()};
  frame.gripper.id = in.u8();
  frame.gripper.position = in.i16();
  frame.gripper.speed = in.i16();
  frame.gripper.current = Milliamperes{in.i16()};
  frame.gripper.status = in.u8();
  frame.gripper.object_detection = in.u8();
  frame.check = in.u8();
  return frame;
}

TelemetryBytes encode(const TelemetryFrame& frame) noexcept {
  TelemetryBytes bytes;
  Writer out{bytes};
  out.header(kTelemetryPayloadSize);
  out.joints(frame.position);
  out.joints(frame.speed);
  out.u8(frame.homed);
  out.u8(frame.io);
  out.u8(frame.temperature_error);
  out.u8(frame.position_error);
  out.u16(frame.timing);
  out.u8(frame.timeout_error);
  out.u8(static_cast<std::uint8_t>(frame.echo));
  out.u8(frame.gripper.id);
  out.i16(frame.gripper.position);
  out.i16(frame.gripper.speed);
  out.i16(frame.gripper.current.value);
  out.u8(frame.gripper.status);
  out.u8(frame.gripper.object_detection);
  out.u8(frame.check);
  out.end();
  return bytes;
}

}  // namespace armjig::parol6
