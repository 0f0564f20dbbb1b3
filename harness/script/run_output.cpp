// SPDX-License-Identifier: Apache-2.0
#include "harness/script/run_output.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/joint_table.hpp"
#include "harness/script/format.hpp"
#include "harness/script/json_line.hpp"

namespace armjig::script {
namespace {

using Errors = std::array<std::int32_t, parol6::kJointCount>;

std::size_t worst_of(const Errors& errors) {
  const auto worst =
      std::ranges::max_element(errors, {}, [](std::int32_t error) { return std::abs(error); });
  return static_cast<std::size_t>(worst - errors.begin());
}

std::string text_of(std::size_t joint, std::int32_t steps) {
  return fmt::format("{:+} steps, {:+.3f} deg", steps,
                     parol6::planning::degrees_of(joint, Steps{steps}));
}

bool has_moved(const std::vector<RunSample>& samples, std::size_t joint) {
  return std::ranges::any_of(samples, [&](const RunSample& sample) {
    return sample.wanted[joint] != samples.front().wanted[joint];
  });
}

/// A line of a plot; between moves it has a gap.
template <class Value>
Series series_of(const std::vector<RunSample>& samples, std::string name, Value value) {
  Series series{std::move(name), {}, Shape::kLine};
  const RunSample* before = nullptr;
  for (const auto& sample : samples) {
    const double time = parol6::planning::kTick * static_cast<double>(sample.frame);
    if (before != nullptr && sample.frame > before->frame + 1) {
      series.points.push_back({time, std::numeric_limits<double>::quiet_NaN()});
    }
    series.points.push_back({time, value(sample)});
    before = &sample;
  }
  return series;
}

}  // namespace

Table results_table(const Program& program, const ProgramRun& run) {
  Table table{{"line", "command", "worst on the way", "error", "worst at the end", "error"}, {}};
  for (const auto& move : run.moves()) {
    const auto& statement = program.statements[move.statement];
    const auto way = worst_of(move.largest_error);
    const auto end = worst_of(move.final_error);
    table.rows.push_back({std::to_string(statement.place.line),
                          to_text(statement.command, program.dialect), fmt::format("j{}", way + 1),
                          text_of(way, move.largest_error[way]), fmt::format("j{}", end + 1),
                          text_of(end, move.final_error[end])});
  }
  return table;
}

std::string to_json(const Program& program, const ProgramRun& run, const RunFacts& facts) {
  nlohmann::ordered_json json{
      {"schema", "armjig.run/1"},
      {"file", facts.file},
      {"target", facts.target},
      {"dialect", to_string(program.dialect)},
      {"ran_to_end", facts.ran_to_end},
      {"moves", nlohmann::ordered_json::array()},
      {"final_position_steps", nlohmann::ordered_json::array()},
      {"link",
       {{"sent", facts.link.sent},
        {"answered", facts.link.answered},
        {"late", facts.link.late},
        {"lost", facts.link.lost}}},
  };
  for (const auto& move : run.moves()) {
    const auto& statement = program.statements[move.statement];
    const bool follows_speed = move.tracking == parol6::planning::Tracking::kSpeed;
    json["moves"].push_back({{"line", statement.place.line},
                             {"command", to_text(statement.command, program.dialect)},
                             {"tracking", follows_speed ? "speed" : "speed and position"},
                             {"largest_error_steps", move.largest_error},
                             {"final_error_steps", move.final_error}});
  }
  for (const auto& position : facts.position) {
    json["final_position_steps"].push_back(position.value);
  }
  return json_line(json);
}

RunPlots run_plots(const ProgramRun& run) {
  RunPlots plots{{"Place of the joints", {"time / s"}, {"place / deg"}, {}},
                 {"Place minus set-point", {"time / s"}, {"error / steps"}, {}}};
  const auto& samples = run.samples();
  for (std::size_t j = 0; j < parol6::kJointCount; ++j) {
    if (!has_moved(samples, j)) continue;
    const auto name = fmt::format("j{}", j + 1);
    plots.position.series.push_back(series_of(samples, name, [j](const RunSample& sample) {
      return parol6::planning::degrees_of(j, sample.seen[j]);
    }));
    plots.error.series.push_back(series_of(samples, name, [j](const RunSample& sample) {
      return static_cast<double>(sample.seen[j].value - sample.wanted[j].value);
    }));
  }
  return plots;
}

}  // namespace armjig::script
