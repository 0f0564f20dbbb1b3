// SPDX-License-Identifier: Apache-2.0
#include "harness/console/parol6/view.hpp"

#include <fmt/core.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <string_view>

#include "harness/wire/parol6/fields.hpp"
#include "harness/wire/parol6/joints.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::console {

using namespace drive;

namespace {

double milliseconds(Duration duration) {
  return std::chrono::duration<double, std::milli>{duration}.count();
}

std::string_view on_off(std::uint8_t flags, std::uint8_t bit) {
  return (flags & bit) != 0 ? "on" : "off";
}

std::string_view estop_text(const TelemetryFrame& frame) {
  return is_estop_pressed(frame) ? "PRESSED" : "released";
}

/// `j1 j3`, or `none`.
std::string joints_in(std::uint8_t flags) {
  std::string text;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if ((flags & flag(j)) != 0) text += fmt::format("{}j{}", text.empty() ? "" : " ", j + 1);
  }
  return text.empty() ? "none" : text;
}

std::string joint_table(const TelemetryFrame& frame) {
  auto text = fmt::format("{:<6}{:>10}{:>13}{:>11}{:>13}  {}\n", "joint", "steps", "degrees",
                          "steps/s", "deg/s", "homed");
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto position = frame.position[j];
    const auto speed = frame.speed[j];
    text += fmt::format("j{:<5}{:>10}{:>13.4f}{:>11}{:>13.4f}  {}\n", j + 1, position.value,
                        kJoints[j].angle(position).value, speed.value,
                        kJoints[j].speed(speed).value, is_homed(frame, j) ? "yes" : "no");
  }
  return text;
}

std::string gripper_text(const GripperReport& gripper) {
  constexpr std::array<std::string_view, 4> kObjects{"none", "met while closing",
                                                     "met while opening", "at its position"};
  const auto& status = *find_field(telemetry_fields(), "gripper.status");
  return fmt::format("position {}, {} mA, object: {}\n           status {}\n", gripper.position,
                     gripper.current.value,
                     kObjects[static_cast<std::size_t>(object_of(gripper.status))],
                     field_text(status, gripper.status));
}

}  // namespace

std::string panel(const TelemetryFrame& frame) {
  return fmt::format(
      "{}\n"
      "estop      {}\n"
      "inputs     in1 {}, in2 {}\n"
      "outputs    out1 {}, out2 {}\n"
      "gripper    {}"
      "errors     temperature {}, position {}, timeout {}\n"
      "timing     {:.3f} ms since the frame before, answer to {}\n",
      joint_table(frame), estop_text(frame), on_off(frame.io, io_flag::kIn1),
      on_off(frame.io, io_flag::kIn2), on_off(frame.io, io_flag::kOut1),
      on_off(frame.io, io_flag::kOut2), gripper_text(frame.gripper),
      joints_in(frame.temperature_error), joints_in(frame.position_error), frame.timeout_error,
      milliseconds(interval_of(frame.timing)), name_of(frame.echo));
}

std::string one_line(const TelemetryFrame& frame) {
  std::string text = "deg";
  for (std::size_t j = 0; j < kJointCount; ++j) {
    text += fmt::format(" {:.3f}", kJoints[j].angle(frame.position[j]).value);
  }
  return text + fmt::format("  homed {}  estop {}  in {} {}  out {} {}  gripper {}",
                            joints_in(frame.homed), estop_text(frame),
                            on_off(frame.io, io_flag::kIn1), on_off(frame.io, io_flag::kIn2),
                            on_off(frame.io, io_flag::kOut1), on_off(frame.io, io_flag::kOut2),
                            frame.gripper.position);
}

std::string link_panel(const DriveStatistics& link) {
  return fmt::format(
      "link       {} sent, {} answered, {} lost, {} late, {} bad, {} surplus\n"
      "round trip {} at 50 %, 99 % and most\n",
      link.sent, link.answered, link.lost, link.late, link.bad, link.surplus,
      link.round_trip.summary());
}

}  // namespace armjig::parol6::console
