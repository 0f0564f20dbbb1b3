// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/capture_options.hpp"
#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/program_judge.hpp"
#include "cli/report_files.hpp"
#include "cli/terminal.hpp"
#include "emulators/lab/run_program.hpp"
#include "emulators/lab/virtual_i2c.hpp"

namespace armjig::cli {
namespace {

constexpr auto kLabHelp =
    "Devices of which programs cannot tell that they are emulated.\n"
    "\n"
    "  armjig lab exec --i2c nodes.toml -- i2cdetect -y 1     a bus for one program\n"
    "  armjig lab exec --i2c nodes.toml --bus 7 -- bash       or for a whole shell\n"
    "\n"
    "The program, and what it starts, finds the bus as /dev/i2c-N; nobody else does. It needs no\n"
    "root, no kernel module and no change of the program, but one that is linked with the C "
    "library\n"
    "(umockdev leads its calls here). nodes.toml has a part for each device:\n"
    "\n"
    "  [[node]]          # a MORAP motor node\n"
    "  id = 2            # its address is 0x10 | id\n"
    "  motor = \"dcx22l\"  # or dcx26l; profile, inertia, viscous, dry, load, shunt, has_shaft\n"
    "  [[pen]]           # at 0x19\n"
    "  [[thermometer]]   # any other device\n"
    "  address = 0x48\n"
    "\n"
    "With --check the program is held to what is demanded of the masters of MORAP nodes: what it\n"
    "does wrong is said at once, and a report at the end, both on standard error.\n"
    "\n"
    "Exit code: that of the program, or 128 and the number of the signal that ended it; with "
    "--check\n"
    "1 for findings and 4 if nobody was told anything, unless the program failed itself.";

struct LabOptions {
  std::string nodes;
  int number = 1;
  bool wants_check = false;
  CaptureOptions capture;
  ReportFiles files;
  std::string colour;
  std::vector<std::string> program;
};

/// Standard output is the program's.
Exit conclude(const Report& result, const LabOptions& options, const ReportOutputs& files,
              Exit of_program) {
  fmt::print(stderr, "{}\n", to_text(result, style_of(options.colour, stderr)));
  files.put(result);
  return of_program == Exit::kPassed ? static_cast<Exit>(conclusion_of(result)) : of_program;
}

/// The device whose emulated bus can be read from a file.
Outcome<const Device*> bus_device(Devices devices) {
  for (const auto& device : devices) {
    const auto* const bus = std::get_if<OnBus>(&device.port);
    if (bus != nullptr && std::ranges::count(device.options(), "file", &OptionRow::name) > 0) {
      return &device;
    }
  }
  return problem(ErrorCode::kUnsupported, "--i2c", "this program has no device on a bus");
}

Exit exec(Devices devices, const LabOptions& options) {
  if (options.nodes.empty()) {
    return report({ErrorCode::kBadValue, "--i2c is missing", "name a TOML file with the devices"});
  }
  if (options.program.empty()) {
    return report({ErrorCode::kBadValue, "PROGRAM is missing", "write it behind --"});
  }
  const auto device = bus_device(devices);
  if (!device) return report(device.error());
  auto bus = std::get<OnBus>((*device)->port).emulate({{"file", options.nodes}}, "--i2c");
  if (!bus) return report(bus.error());
  std::unique_ptr<ProgramCheck> check;
  if (options.wants_check) {
    // A program waits for each transaction, and the time of the bus never falls behind the wall
    // clock meanwhile: no pause is seen shorter than the program made it, so there is no noise.
    auto made = make_program_check(**device, {});
    if (!made) return report(made.error());
    check = *std::move(made);
  }
  const auto files = ReportOutputs::open(options.files, "PROGRAM");
  if (!files) return report(files.error());
  const auto file = open_capture_file("--capture", options.capture);
  if (!file) return report(file.error());
  auto capture =
      HostedCapture::open(*file, **device, "emulated:?file=" + options.nodes, epoch_of({}));
  if (!capture) return report(capture.error());
  auto hosted = capture->watch(*std::move(bus));
  if (check) hosted = check->watch(std::move(hosted));
  const auto i2c = VirtualI2c::open(std::move(hosted), options.number);
  if (!i2c) return report(i2c.error());
  const auto code = run_program(options.program, i2c->environment());
  if (!code) return report(code.error());
  const auto ended = static_cast<Exit>(*code);
  return check ? conclude(check->finish(), options, *files, ended) : ended;
}

}  // namespace

void add_lab(CLI::App& app, Devices devices, Action& action) {
  auto* lab = app.add_subcommand("lab", kLabHelp);
  lab->require_subcommand(1);
  auto* command = lab->add_subcommand("exec", "Runs a program that finds emulated devices.");
  const auto options = std::make_shared<LabOptions>();
  command->add_option("--i2c", options->nodes, "the devices of an I2C bus")
      ->type_name("NODES.toml");
  command->add_option("--bus", options->number, "its number, 0 to 255 (default: 1)")
      ->type_name("N")
      ->transform(whole(0, 255));
  add_capture_options(*command, options->capture);
  auto* check = command->add_flag("--check", options->wants_check, "judge the program");
  for (auto* file : add_report_files(*command, options->files)) file->needs(check);
  add_colour_option(*command, options->colour);
  command->add_option("PROGRAM", options->program, "and its arguments, behind --")->type_name("");
  when_chosen(*command, action, [options, devices] { return exec(devices, *options); });
}

}  // namespace armjig::cli
