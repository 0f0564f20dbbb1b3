// SPDX-License-Identifier: Apache-2.0
#include "harness/script/plan_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "harness/arm/arm.hpp"
#include "harness/arm/models.hpp"
#include "harness/arm/orientation.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/joint_table.hpp"
#include "harness/script/format.hpp"
#include "harness/script/json_line.hpp"

namespace armjig::script {
namespace {

using parol6::JointSteps;
using parol6::kJointCount;
using parol6::planning::kTick;

double time_of(std::size_t frame) noexcept { return static_cast<double>(frame) * kTick; }

double degrees_per_step(std::size_t joint) noexcept {
  return parol6::planning::degrees_of(joint, Steps{1});
}

/// What one move asks of the joint that does most.
struct Peak {
  std::size_t joint{};
  double speed{};  ///< steps/s
  double share{};  ///< of what the joint can do
};

Peak peak_of(const parol6::planning::Plan& plan) {
  Peak peak;
  for (const auto& point : plan.set_points) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const double speed = std::abs(point.speed[j].value);
      const double share = speed / parol6::kJoints[j].max_speed.value;
      if (share > peak.share) peak = {j, speed, share};
    }
  }
  return peak;
}

/// The joint with the longest way, and how far that is, degrees.
struct Leader {
  std::size_t joint{};
  double degrees{};
};

Leader leader_of(const JointSteps& from, const JointSteps& to) {
  std::array<double, kJointCount> ways{};
  for (std::size_t j = 0; j < kJointCount; ++j)
    ways[j] = parol6::planning::degrees_of(j, to[j] - from[j]);
  // Not a loop that keeps the longest so far: Clang 19.1.7 unrolls that one wrongly.
  const auto longest = std::ranges::max_element(ways, {}, [](double way) { return std::abs(way); });
  return {static_cast<std::size_t>(longest - ways.begin()), *longest};
}

std::string_view law_of(const parol6::planning::Plan& plan) noexcept {
  return plan.law == parol6::planning::Law::kTrapezoid ? "trapezoid" : "polynomial";
}

std::string_view tracking_of(const parol6::planning::Plan& plan) noexcept {
  return plan.tracking == parol6::planning::Tracking::kSpeed ? "speed" : "speed and position";
}

const JointSteps& end_of(const ScheduledMove& move) noexcept {
  return move.plan.set_points.empty() ? move.start : move.plan.set_points.back().position;
}

/// The tool as the commander displays it.
struct Tool {
  arm::Vector3 millimetres{};
  std::array<double, 3> degrees{};
};

class Kinematics {
 public:
  [[nodiscard]] Tool tool(const JointSteps& positions) const {
    const auto pose = arm::forward(arm_, parol6::planning::radians_of(positions));
    const auto angles = arm::angles_of(pose.rotation, arm::Convention::kCommander);
    return {1000.0 * pose.position,
            {parol6::planning::to_degrees(angles.rx), parol6::planning::to_degrees(angles.ry),
             parol6::planning::to_degrees(angles.rz)}};
  }

  /// From the base to the tool, mm.
  [[nodiscard]] std::vector<ScenePoint> chain(const JointSteps& positions) const {
    std::array<arm::Pose, kJointCount + 1> frames;
    arm::forward_all(arm_, parol6::planning::radians_of(positions), frames);
    std::vector<ScenePoint> points{{}};
    for (const auto& frame : frames) {
      const auto [x, y, z] = 1000.0 * frame.position;
      points.push_back({x, y, z});
    }
    return points;
  }

 private:
  arm::Arm arm_ = arm::parol6_commander();
};

/// A series for each joint; `value(frame, joint)` is its ordinate.
template <class Value>
Plot joint_plot(std::string title, std::string label, std::size_t frames, Value value) {
  Plot plot{std::move(title), {"time / s"}, {std::move(label)}, {}};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Series series{fmt::format("j{}", j + 1), {}, Shape::kLine};
    for (std::size_t i = 0; i < frames; ++i) series.points.push_back({time_of(i), value(i, j)});
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// A joint that stands is told no speed, also by frames that carry none.
double speed_of(const Schedule& schedule, std::size_t frame, std::size_t joint) {
  return schedule.frames[frame].speed[joint].value * degrees_per_step(joint);
}

std::vector<Plot> joint_plots(const Schedule& schedule) {
  const auto count = schedule.frames.size();
  return {joint_plot("Position of each joint", "position / deg", count,
                     [&](std::size_t i, std::size_t j) {
                       return parol6::planning::degrees_of(j, schedule.positions[i][j]);
                     }),
          joint_plot("Speed of each joint", "speed / (deg/s)", count,
                     [&](std::size_t i, std::size_t j) { return speed_of(schedule, i, j); }),
          joint_plot("Acceleration of each joint, from frame to frame", "acceleration / (deg/s²)",
                     count, [&](std::size_t i, std::size_t j) {
                       const double before = i == 0 ? 0 : speed_of(schedule, i - 1, j);
                       return (speed_of(schedule, i, j) - before) / kTick;
                     })};
}

ReportSection tool_section(const Schedule& schedule) {
  const Kinematics kinematics;
  ReportSection section{.title = "Tool"};
  Plot place{"Place of the tool", {"time / s"}, {"place / mm"}, {{"x"}, {"y"}, {"z"}}};
  Plot above{"Path of the tool from above", {"x / mm"}, {"y / mm"}, {{.shape = Shape::kDots}}};
  Plot side{"Path of the tool from the side", {"x / mm"}, {"z / mm"}, {{.shape = Shape::kDots}}};
  Scene scene{"The arm in motion", "mm", {}};
  for (std::size_t i = 0; i < schedule.positions.size(); ++i) {
    const auto [x, y, z] = kinematics.tool(schedule.positions[i]).millimetres;
    place.series[0].points.push_back({time_of(i), x});
    place.series[1].points.push_back({time_of(i), y});
    place.series[2].points.push_back({time_of(i), z});
    above.series[0].points.push_back({x, y});
    side.series[0].points.push_back({x, z});
    scene.poses.push_back({time_of(i), kinematics.chain(schedule.positions[i])});
  }
  section.scenes.push_back(std::move(scene));
  section.plots = {std::move(place), std::move(above), std::move(side)};
  return section;
}

template <class Values>
std::vector<std::int32_t> values_of(const Values& quantities) {
  std::vector<std::int32_t> values;
  for (const auto& quantity : quantities) values.push_back(quantity.value);
  return values;
}

nlohmann::ordered_json to_json(const Program& program, const ScheduledMove& move) {
  const auto& statement = program.statements[move.statement];
  nlohmann::ordered_json json{
      {"line", statement.place.line},
      {"column", statement.place.column},
      {"command", to_text(statement.command, program.dialect)},
      {"law", law_of(move.plan)},
      {"tracking", tracking_of(move.plan)},
      {"first_frame", move.first_frame},
      {"set_points", move.plan.set_points.size()},
      {"begins_s", time_of(move.first_frame)},
      {"duration_s", move.plan.duration},
      {"leading_joint", leader_of(move.start, end_of(move)).joint + 1},
      {"start_steps", values_of(move.start)},
      {"end_steps", values_of(end_of(move))},
      {"singularities", nlohmann::ordered_json::array()},
  };
  for (const auto& note : move.plan.singularities) {
    json["singularities"].push_back({{"time_s", note.time}, {"text", describe(note)}});
  }
  if (move.plan.stop) json["stops"] = describe(*move.plan.stop);
  return json;
}

}  // namespace

Table moves_table(const Program& program, const Schedule& schedule) {
  Table table{{"line", "command", "law", "begins", "takes", "leads", "its way", "busiest", "peak",
               "of its most"},
              {}};
  for (const auto& move : schedule.moves) {
    const auto& statement = program.statements[move.statement];
    const auto leader = leader_of(move.start, end_of(move));
    const auto peak = peak_of(move.plan);
    table.rows.push_back(
        {std::to_string(statement.place.line), to_text(statement.command, program.dialect),
         std::string{law_of(move.plan)}, fmt::format("{:.2f} s", time_of(move.first_frame)),
         fmt::format("{:.2f} s", move.plan.duration), fmt::format("j{}", leader.joint + 1),
         fmt::format("{:.2f} deg", leader.degrees), fmt::format("j{}", peak.joint + 1),
         fmt::format("{:.0f} steps/s", peak.speed), fmt::format("{:.0f} %", 100 * peak.share)});
  }
  return table;
}

std::string to_csv(const Program& program, const Schedule& schedule) {
  const Kinematics kinematics;
  std::string csv = "frame,time_s,line,command";
  auto out = std::back_inserter(csv);
  for (const auto* unit : {"position_steps", "speed_steps_per_s", "position_deg"}) {
    for (std::size_t j = 1; j <= kJointCount; ++j) fmt::format_to(out, ",j{}_{}", j, unit);
  }
  csv += ",x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg\n";
  for (std::size_t i = 0; i < schedule.frames.size(); ++i) {
    const auto& frame = schedule.frames[i];
    const auto& positions = schedule.positions[i];
    const auto [place, angles] = kinematics.tool(positions);
    fmt::format_to(out, "{},{:.2f},{},{}", i, time_of(i),
                   program.statements[schedule.statements[i]].place.line,
                   static_cast<int>(frame.command));
    for (const auto& position : frame.position) fmt::format_to(out, ",{}", position.value);
    for (const auto& speed : frame.speed) fmt::format_to(out, ",{}", speed.value);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      fmt::format_to(out, ",{:.6f}", parol6::planning::degrees_of(j, positions[j]));
    }
    fmt::format_to(out, ",{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n", place.x, place.y, place.z,
                   angles[0], angles[1], angles[2]);
  }
  return csv;
}

std::string to_json(const Program& program, const Schedule& schedule, std::string_view file) {
  nlohmann::ordered_json json{
      {"schema", "armjig.plan/1"},
      {"file", file},
      {"dialect", to_string(program.dialect)},
      {"period_s", kTick},
      {"duration_s", schedule.seconds()},
      {"moves", nlohmann::ordered_json::array()},
      {"frames", nlohmann::ordered_json::array()},
  };
  for (const auto& move : schedule.moves) json["moves"].push_back(to_json(program, move));
  for (std::size_t i = 0; i < schedule.frames.size(); ++i) {
    const auto& frame = schedule.frames[i];
    json["frames"].push_back({{"line", program.statements[schedule.statements[i]].place.line},
                              {"command", static_cast<int>(frame.command)},
                              {"position_steps", values_of(frame.position)},
                              {"speed_steps_per_s", values_of(frame.speed)}});
  }
  if (schedule.stop) {
    json["stops"] = {{"line", schedule.stop->place.line}, {"text", schedule.stop->text}};
  }
  return json_line(json);
}

Report to_report(const Program& program, const Schedule& schedule, std::string_view file) {
  Report report{.title = fmt::format("Plan of {}", file)};
  report.facts = {{"dialect", std::string{to_string(program.dialect)}},
                  {"takes", fmt::format("{:.2f} s", schedule.seconds())},
                  {"frames", std::to_string(schedule.frames.size())},
                  {"moves", std::to_string(schedule.moves.size())}};
  if (schedule.stop) report.facts.emplace_back("ends early", schedule.stop->text);
  report.sections.push_back({.title = "Moves", .table = moves_table(program, schedule)});
  report.sections.push_back(tool_section(schedule));
  report.sections.push_back({.title = "Joints", .plots = joint_plots(schedule)});
  return report;
}

}  // namespace armjig::script
