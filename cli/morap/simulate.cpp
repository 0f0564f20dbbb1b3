// SPDX-License-Identifier: Apache-2.0
#include "cli/morap/commands.hpp"

#include <fmt/core.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/checks.hpp"
#include "cli/morap/arguments.hpp"
#include "cli/outputs.hpp"
#include "emulators/morap/step_response.hpp"
#include "harness/drive/morap/parameter_file.hpp"
#include "harness/files/user_file.hpp"
#include "harness/report/report.hpp"
#include "harness/report/wording.hpp"

namespace armjig::cli {
namespace {

using namespace morap;
using namespace morap::drive;
using namespace morap::emulation;

constexpr auto kSimulateHelp =
    "A step response of an emulated node, as numbers and plots.\n"
    "\n"
    "  armjig morap simulate --type pid --inertia 0.2 --pole -6 --step 0.3\n"
    "  armjig morap simulate --params joint.toml --inertia 0.2 --dry 0.3 --html step.html\n"
    "  armjig morap simulate ... --csv ideal.csv, then ... --dry 0.3 --beside ideal.csv --html "
    "both.html\n"
    "\n"
    "--beside draws a recording into the plots, such as one of the real joint: lines "
    "'seconds,value'"
    ",\n"
    "in rad or rad/s; further columns and lines that do not begin with a number are passed over.";

struct SimulateOptions {
  TuneArguments tuning;
  std::string params;
  std::string motor{kDcx22l.name};
  double step = 0.5;
  double seconds = 2;
  double viscous = 0;
  double dry = 0;
  double load = 0;
  double current = 0;  ///< rated; 0: the motor's
  std::string csv;
  std::string html;
  std::string svg;
  std::string beside;
};

Outcome<StepTest> test_of(const SimulateOptions& options) {
  StepTest test;
  test.reference = static_cast<float>(options.step);
  test.length = duration_of(options.seconds);
  test.node.eeprom = eeprom_of(options.motor);
  auto& motor = test.node.eeprom.motor;
  if (options.current > 0) motor.rated_current = static_cast<float>(options.current);
  test.node.plant = plant_of(motor, options.tuning.inertia, options.viscous, options.dry);
  test.node.plant->load_torque = options.load;
  if (options.params.empty()) {
    const auto request = options.tuning.request();
    if (const auto refusal = refusal_of(request); !refusal.empty()) {
      return problem(ErrorCode::kBadValue, "--inertia, --pole", refusal);
    }
    test.controller = request;
    return test;
  }
  const auto set = read_parameters(options.params);
  if (!set) return tl::unexpected{set.error()};
  test.controller = *set;
  return test;
}

Outcome<std::vector<PlotPoint>> read_recording(const std::string& path) {
  auto file = UserFile::open(path);
  if (!file) return tl::unexpected{file.error()};
  std::vector<PlotPoint> points;
  while (true) {
    const auto line = file->next_line();
    if (!line) return tl::unexpected{line.error()};
    if (!*line) break;
    PlotPoint point;
    const auto* const end = (*line)->data() + (*line)->size();
    const auto [comma, no_time] = std::from_chars((*line)->data(), end, point.x);
    if (no_time != std::errc{} || comma == end || *comma != ',') continue;
    const auto [_, no_value] = std::from_chars(comma + 1, end, point.y);
    const bool is_finite = std::isfinite(point.x) && std::isfinite(point.y);
    if (no_value == std::errc{} && is_finite) points.push_back(point);
  }
  if (!points.empty()) return points;
  return problem(ErrorCode::kMalformed, path, "there is no line 'seconds,value' in it");
}

std::string csv_of(const StepResponse& response) {
  std::string text = "seconds,value,volts,amperes\n";
  for (const auto& sample : response.samples) {
    text += fmt::format("{:.6f},{:.9g},{:.6f},{:.6f}\n", wording::seconds(sample.time),
                        sample.value, sample.volts, sample.amperes);
  }
  return text;
}

Series series_of(const StepResponse& response, std::string name, double StepSample::* what) {
  Series series{std::move(name), {}, Shape::kLine};
  for (const auto& sample : response.samples) {
    series.points.push_back({wording::seconds(sample.time), sample.*what});
  }
  return series;
}

/// Of a recording, for the legend.
std::string name_of(const std::string& path) { return std::filesystem::path{path}.stem().string(); }

std::vector<Plot> plots_of(const StepResponse& response, const SimulateOptions& options,
                           std::vector<PlotPoint> recording) {
  const bool is_speed = response.controller.kind == ControllerKind::kSpeed;
  const std::string unit = is_speed ? "speed / (rad/s)" : "angle / rad";
  const Axis time{"time / s"};
  const Series asked{
      "reference", {{0, options.step}, {options.seconds, options.step}}, Shape::kLine};
  Plot answer{is_speed ? "Speed" : "Angle",
              time,
              {unit},
              {series_of(response, "simulated", &StepSample::value), asked}};
  if (!recording.empty())
    answer.series.push_back({name_of(options.beside), std::move(recording), Shape::kLine});
  return {answer,
          {"Voltage", time, {"voltage / V"}, {series_of(response, {}, &StepSample::volts)}},
          {"Current", time, {"current / A"}, {series_of(response, {}, &StepSample::amperes)}}};
}

std::string controller_of(const SimulateOptions& options) {
  if (!options.params.empty()) return options.params;
  return fmt::format("{}, pole {} 1/s", options.tuning.type, options.tuning.pole);
}

Report report_of(const StepResponse& response, const SimulateOptions& options,
                 std::vector<PlotPoint> recording) {
  const bool has_settled = wording::seconds(response.settling) < options.seconds;
  Report report;
  report.title = "MORAP step response";
  report.facts = {{"controller", controller_of(options)},
                  {"motor", options.motor},
                  {"inertia", fmt::format("{} kg m^2", options.tuning.inertia)},
                  {"step", fmt::format("{}", options.step)},
                  {"dry friction", fmt::format("{} N m", options.dry)},
                  {"viscous friction", fmt::format("{} N m s", options.viscous)},
                  {"load", fmt::format("{} N m", options.load)}};
  Table figures{
      {"overshoot", "settled (2 %)", "final value", "peak voltage"},
      {{fmt::format("{:.2f} %", response.overshoot * 100),
        has_settled ? fmt::format("{:.3f} s", wording::seconds(response.settling)) : "never",
        fmt::format("{:.6f}", response.final_value),
        fmt::format("{:.3f} V", response.peak_volts)}}};
  report.sections = {
      {"Figures", {}, std::move(figures), {}},
      {"Plots", {}, {}, plots_of(response, options, std::move(recording))},
  };
  return report;
}

Exit simulate(const SimulateOptions& options) {
  const auto test = test_of(options);
  if (!test) return cli::report(test.error());
  std::vector<PlotPoint> recording;
  if (!options.beside.empty()) {
    auto read = read_recording(options.beside);
    if (!read) return cli::report(read.error());
    recording = *std::move(read);
  }
  const auto files =
      open_outputs({{"--csv", options.csv}, {"--svg", options.svg}, {"--html", options.html}});
  if (!files) return cli::report(files.error());
  const auto response = run(*test);
  if (!response.is_accepted) {
    fmt::print(stderr, "armjig: the node refuses the controller\n");
    return Exit::kFindings;
  }
  const auto made = report_of(response, options, std::move(recording));
  for (const auto& [name, value] : made.facts) fmt::print("{:<17} {}\n", name, value);
  fmt::print("{}", to_text(made.sections.front()));
  const auto& [csv, svg, html] = *files;
  if (csv) csv->put(csv_of(response));
  if (svg) svg->put(to_svg(made.sections.back().plots.front()));
  if (html) html->put(to_html(made));
  return Exit::kPassed;
}

void add_plant_options(CLI::App& command, SimulateOptions& options) {
  const auto add = [&command](const char* name, double& value, const char* what, const char* unit,
                              double least, double most) {
    command.add_option(name, value, what)
        ->type_name(unit)
        ->check(number(least, most))
        ->capture_default_str();
  };
  add("--seconds", options.seconds, "how long", "S", 0.01, 600);
  add("--viscous", options.viscous, "friction at the output shaft", "N.m.s", 0, 1e3);
  add("--dry", options.dry, "friction at the output shaft", "N.m", 0, 1e3);
  add("--load", options.load, "torque on the output shaft", "N.m", -1e3, 1e3);
  add("--current", options.current, "rated, to which the node limits; 0: the motor's", "A", 0, 1e3);
}

}  // namespace

void add_morap_simulate(CLI::App& morap, Action& action) {
  auto* command = morap.add_subcommand("simulate", kSimulateHelp);
  const auto options = std::make_shared<SimulateOptions>();
  const auto tuning = add_tune_options(*command, options->tuning);
  tuning.inertia->required();
  auto* params = command
                     ->add_option("--params", options->params,
                                  "a file with the controller, instead of --type and --pole")
                     ->type_name("FILE")
                     ->excludes(tuning.type)
                     ->excludes(tuning.pole);
  add_motor_option(*command, options->motor);
  command->add_option("--step", options->step, "to where: rad, or rad/s of speed control; not 0")
      ->type_name("VALUE")
      ->check(number(-1e3, 1e3))
      ->capture_default_str();
  add_plant_options(*command, *options);
  command->add_option("--csv", options->csv, "write all samples to this file")->type_name("FILE");
  command->add_option("--html", options->html, "write a page with plots to this file")
      ->type_name("FILE");
  command->add_option("--svg", options->svg, "write the plot of the answer to this file")
      ->type_name("FILE");
  command->add_option("--beside", options->beside, "draw this recording into the plot")
      ->type_name("FILE");
  command->callback([options, params, &action] {
    const bool has_tuning = !options->tuning.type.empty() && options->tuning.pole != 0;
    if (params->count() == 0 && !has_tuning) {
      throw CLI::ValidationError{"morap simulate", "say --type and --pole, or --params"};
    }
    if (options->step == 0) {
      throw CLI::ValidationError{"--step", "a step of that size shows nothing"};
    }
    action = [options] { return simulate(*options); };
  });
}

}  // namespace armjig::cli
