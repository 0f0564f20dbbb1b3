// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/parol6/telemetry_json.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "harness/wire/parol6/fields.hpp"
#include "harness/wire/parol6/joints.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::drive {
namespace {

using Json = nlohmann::ordered_json;

/// A millionth of a degree is far below a step.
double rounded(double value) { return std::round(value * 1e6) / 1e6; }

double as_microseconds(Duration duration) {
  return std::chrono::duration<double, std::micro>{duration}.count();
}

Json joints_json(const TelemetryFrame& frame) {
  Json joints = Json::array();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    joints.push_back({{"position_steps", frame.position[j].value},
                      {"position_deg", rounded(kJoints[j].angle(frame.position[j]).value)},
                      {"speed_steps_s", frame.speed[j].value},
                      {"speed_deg_s", rounded(kJoints[j].speed(frame.speed[j]).value)},
                      {"homed", is_homed(frame, j)}});
  }
  return joints;
}

Json gripper_json(const GripperReport& gripper) {
  constexpr std::array<std::string_view, 4> kObjects{"none", "while_closing", "while_opening",
                                                     "at_position"};
  return {{"position", gripper.position},
          {"speed", gripper.speed},
          {"current_ma", gripper.current.value},
          {"status", gripper.status},
          {"calibrated", (gripper.status & gripper_status::kCalibrated) != 0},
          {"object", kObjects[static_cast<std::size_t>(object_of(gripper.status))]}};
}

Json link_json(const DriveStatistics& link) {
  const auto& trip = link.round_trip;
  return {{"sent", link.sent},
          {"answered", link.answered},
          {"late", link.late},
          {"lost", link.lost},
          {"bad", link.bad},
          {"surplus", link.surplus},
          {"round_trip_us",
           {{"min", as_microseconds(trip.min())},
            {"p50", as_microseconds(trip.percentile(50))},
            {"p99", as_microseconds(trip.percentile(99))},
            {"max", as_microseconds(trip.max())}}}};
}

}  // namespace

std::string to_json(Instant time, const TelemetryFrame& frame, const DriveStatistics& link) {
  const auto is_on = [&](std::uint8_t bit) { return (frame.io & bit) != 0; };
  const auto echo = static_cast<std::int64_t>(frame.echo);
  const Json json{
      {"schema", "armjig.telemetry/1"},
      {"device", "parol6"},
      {"t_us", microseconds(time)},
      {"joints", joints_json(frame)},
      {"inputs", {{"in1", is_on(io_flag::kIn1)}, {"in2", is_on(io_flag::kIn2)}}},
      {"outputs", {{"out1", is_on(io_flag::kOut1)}, {"out2", is_on(io_flag::kOut2)}}},
      {"estop_pressed", is_estop_pressed(frame)},
      {"temperature_error", frame.temperature_error},
      {"position_error", frame.position_error},
      {"timeout_error", frame.timeout_error},
      {"timing_us", as_microseconds(interval_of(frame.timing))},
      {"echo",
       {{"value", echo}, {"text", field_text(*find_field(telemetry_fields(), "echo"), echo)}}},
      {"gripper", gripper_json(frame.gripper)},
      {"link", link_json(link)}};
  return json.dump();
}

}  // namespace armjig::parol6::drive
