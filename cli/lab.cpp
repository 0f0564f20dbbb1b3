// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "cli/program_judge.hpp"
#include "cli/report_files.hpp"
#include "emulators/host/morap_bus.hpp"
#include "emulators/host/run_program.hpp"
#include "emulators/host/virtual_i2c.hpp"

namespace armjig::cli {
namespace {

constexpr auto kHelp =
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

struct Options {
  std::string nodes;
  int number = 1;
  bool wants_check = false;
  ReportFiles files;
  std::vector<std::string> program;
};

/// Standard output is the program's.
Exit conclude(const Report& result, const Options& options, Exit of_program) {
  fmt::print(stderr, "{}\n", to_text(result));
  if (const auto written = write_files(result, options.files); !written) {
    return report(written.error());
  }
  return of_program == Exit::kPassed ? static_cast<Exit>(conclusion_of(result)) : of_program;
}

/// Answers a problem of ours, or how the program ended.
Outcome<Exit> run_on(i2c::Bus bus, const Options& options, BusListener listener) {
  const auto i2c = VirtualI2c::open(std::move(bus), options.number, std::move(listener));
  if (!i2c) return tl::unexpected{i2c.error()};
  return run_program(options.program, i2c->environment()).map([](int code) {
    return static_cast<Exit>(code);
  });
}

Exit exec(const Options& options) {
  if (options.nodes.empty()) {
    return report({ErrorCode::kBadValue, "--i2c is missing", "name a TOML file with the devices"});
  }
  if (options.program.empty()) {
    return report({ErrorCode::kBadValue, "no program", "write it behind --"});
  }
  auto bus = morap::read_bus(options.nodes);
  if (!bus) return report(bus.error());
  if (!options.wants_check) {
    const auto ended = run_on(*std::move(bus), options, {});
    return ended ? *ended : report(ended.error());
  }
  const auto check = BusCheck::make("morap");
  if (!check) return report(check.error());
  const auto ended = run_on(*std::move(bus), options, (*check)->listener());
  return ended ? conclude((*check)->finish(), options, *ended) : report(ended.error());
}

}  // namespace

void add_lab(CLI::App& app, Action& action) {
  auto* lab = app.add_subcommand("lab", kHelp);
  lab->require_subcommand(1);
  auto* command = lab->add_subcommand("exec", "Runs a program that finds emulated devices.");
  const auto options = std::make_shared<Options>();
  command->add_option("--i2c", options->nodes, "the devices of an I2C bus")
      ->type_name("NODES.toml");
  command->add_option("--bus", options->number, "its number, 0 to 255 (default: 1)")
      ->type_name("N")
      ->check(CLI::Range(0, 255));
  auto* check = command->add_flag("--check", options->wants_check, "judge the program");
  for (auto* file : add_report_files(*command, options->files)) file->needs(check);
  command->add_option("PROGRAM", options->program, "and its arguments, behind --")->type_name("");
  command->callback([options, &action] { action = [options] { return exec(*options); }; });
}

}  // namespace armjig::cli
