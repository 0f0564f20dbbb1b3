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
#include "cli/lab_file.hpp"
#include "cli/presented.hpp"
#include "cli/report_files.hpp"
#include "cli/serving.hpp"
#include "cli/settings.hpp"
#include "cli/terminal.hpp"
#include "emulators/lab/run_program.hpp"

namespace armjig::cli {
namespace {

constexpr auto kLabHelp =
    "Several devices for programs that cannot tell that they are emulated.\n"
    "\n"
    "  armjig lab up lab.toml                        serves all of them until Ctrl-C\n"
    "  armjig lab exec lab.toml -- python3 app.py    and for one program, which ends it\n"
    "  armjig lab exec --i2c nodes.toml -- bash      a bus alone, for a whole shell";

constexpr auto kUpHelp =
    "Serves the devices of a lab until Ctrl-C or SIGTERM.\n"
    "\n"
    "  armjig lab up lab.toml\n"
    "\n"
    "lab.toml has a part for each device; without a place it is where programs look for one:\n"
    "\n"
    "  [[device]]\n"
    "  device = \"DEVICE\"                  # 'armjig emulate --help' names them\n"
    "  name = \"left\"                      # DEVICE if not given\n"
    "  target = \"emulated:?fault=zero:io\" # or that of a real one, as serial:/dev/ttyACM0\n"
    "  pty = \"/tmp/left\"                  # places: pty, tcp, rfc2217, usb, usbip, ttyACM, i2c\n"
    "  impair = \"loss=1%\"                 # also speed, capture, rotate, redact, check\n"
    "\n"
    "A line for each device says where it listens. /dev/ttyACM-N and /dev/i2c-N are there for\n"
    "programs that are started with the environment that is printed, one after the other or at\n"
    "once; what they do to a device stays. Lines on standard input, NAME.INPUT NUMBER, do what no\n"
    "client can; 'help' lists them. docs/labs.md has it all.\n"
    "\n"
    "Exit codes: 0 it was ended, 1 findings of check = true, 2 the file is wrong, 3 a device that\n"
    "is not emulated is not there, or gone, 4 nobody talked to the devices that are checked.";

constexpr auto kExecHelp =
    "Runs a program that finds emulated devices.\n"
    "\n"
    "  armjig lab exec lab.toml -- python3 app.py             devices as of 'lab up'\n"
    "  armjig lab exec --i2c nodes.toml -- i2cdetect -y 1     a bus alone\n"
    "  armjig lab exec --i2c nodes.toml --bus 7 -- bash       or for a whole shell\n"
    "\n"
    "The program, and what it starts, finds boards as /dev/ttyACM-N with their USB numbers, and "
    "buses\n"
    "as /dev/i2c-N; nobody else does. It needs no root, no kernel module and no change of the\n"
    "program, but one that is linked with the C library (umockdev leads its calls here).\n"
    "nodes.toml has a part for each device on the bus:\n"
    "\n"
    "  [[node]]          # a MORAP motor node\n"
    "  id = 2            # its address is 0x10 | id\n"
    "  motor = \"dcx22l\"  # or dcx26l; profile, inertia, viscous, dry, load, shunt, has_shaft\n"
    "  [[pen]]           # at 0x19\n"
    "  [[thermometer]]   # any other device\n"
    "  address = 0x48\n"
    "\n"
    "With --check, or check = true, the program is judged: what it does wrong is said at once, and "
    "a\n"
    "report at the end, both on standard error.\n"
    "\n"
    "Exit code: that of the program, or 128 and the number of the signal that ended it; of a "
    "program\n"
    "that is judged 1 for findings and 4 if nobody was told anything, unless it failed itself.";

struct UpOptions {
  std::string lab;
  bool wants_json = false;
  std::string colour;
};

struct ExecOptions {
  std::string lab;
  std::string nodes;
  int number = 1;
  bool wants_check = false;
  CaptureOptions capture;
  ReportFiles files;
  std::string colour;
  std::vector<std::string> program;
};

/// The devices of a lab with what is around them.
struct Lab {
  struct One {
    LabDevice plan;
    std::unique_ptr<ProgramCheck> check;  ///< none: nobody is judged
    std::unique_ptr<Presented> presented;
  };
  std::vector<One> all;

  [[nodiscard]] std::vector<ToServe> to_serve() const {
    std::vector<ToServe> devices;
    for (const auto& one : all) {
      auto serving = serving_at(*one.plan.device, one.plan.name, one.plan.places, one.plan.speed);
      if (all.size() > 1) serving.how.log = log_as(one.plan.name);
      devices.push_back({one.presented->take(), std::move(serving)});
    }
    return devices;
  }
};

/// A problem that turned out when a device was opened, with the place in the file.
Problem in_file(const LabDevice& plan, Problem problem) {
  if (!plan.where.empty()) problem.where = fmt::format("{}: {}", plan.where, problem.where);
  return problem;
}

Outcome<Lab::One> open_one_of_lab(LabDevice plan, std::string_view capture_option,
                                  std::string_view name) {
  // A program on a bus waits for each transaction, and the time of the bus never falls behind the
  // wall clock meanwhile: no pause is seen shorter than the program made it.
  auto check = check_if(plan.wants_check, *plan.device, plan.speed, name);
  if (!check) return tl::unexpected{in_file(plan, check.error())};
  auto capture = open_capture_file(capture_option, plan.capture);
  if (!capture) return tl::unexpected{in_file(plan, capture.error())};
  auto presented = Presented::open(*plan.device, {.target = plan.target,
                                                  .capture = *std::move(capture),
                                                  .speed = plan.speed,
                                                  .impairment = plan.impairment,
                                                  .check = check->get()});
  if (!presented) return tl::unexpected{in_file(plan, presented.error())};
  return Lab::One{std::move(plan), *std::move(check), *std::move(presented)};
}

Outcome<Lab> open_lab(std::vector<LabDevice> plans) {
  Lab lab;
  const bool is_only = plans.size() == 1;
  for (auto& plan : plans) {
    const auto name = is_only ? std::string{} : plan.name;
    auto one = open_one_of_lab(std::move(plan), "capture", name);
    if (!one) return tl::unexpected{std::move(one.error())};
    lab.all.push_back(*std::move(one));
  }
  return lab;
}

/// The reports of all judges, each by `show(name, report)`, and what they come to: findings weigh
/// most; nothing ran only if nobody was told anything.
template <class Show>
std::optional<Exit> judge(const Lab& lab, Show show) {
  std::optional<Exit> all;
  for (const auto& one : lab.all) {
    if (!one.check) continue;
    const auto result = one.check->finish();
    show(one.plan.name, result);
    const auto exit = static_cast<Exit>(conclusion_of(result));
    const bool is_worse =
        !all || exit == Exit::kFindings || (*all == Exit::kNothing && exit == Exit::kPassed);
    if (is_worse && all != Exit::kFindings) all = exit;
  }
  return all;
}

/// Names the devices that are not emulated and have gone, and answers what that comes to, if any
/// has. For after the end of all.
std::optional<Exit> tell_gone(const Lab& lab) {
  std::optional<Exit> exit;
  for (const auto& one : lab.all) {
    const auto& failure = one.presented->relayed().failure;
    if (!failure) continue;
    (void)report({failure->code, fmt::format("{}: {}", one.plan.name, one.plan.target.text),
                  "the device has gone"});
    exit = Exit::kRig;
  }
  return exit;
}

Exit up(Devices devices, const UpOptions& options) {
  auto plans = read_lab(options.lab, devices);
  if (!plans) return report(plans.error());
  auto lab = open_lab(*std::move(plans));
  if (!lab) return report(lab.error());
  const auto served = serve(lab->to_serve(), {.announcement = ServerManner::Announcement::kLab,
                                              .wants_json = options.wants_json});
  if (!served) return report(served.error());
  const auto judged = judge(*lab, [&](const std::string& name, const Report& result) {
    if (options.wants_json) return fmt::print("{}\n", to_json(result));
    fmt::print("{}:\n{}\n", name, to_text(result, style_of(options.colour, stdout)));
  });
  const auto gone = tell_gone(*lab);
  return judged == Exit::kFindings ? *judged : gone.value_or(judged.value_or(Exit::kPassed));
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

/// The lab that has nothing but the bus of `--i2c`.
Outcome<std::vector<LabDevice>> lab_of_bus(Devices devices, const ExecOptions& options) {
  return bus_device(devices).map([&](const Device* device) {
    const DeviceOptions nodes{{"file", options.nodes}};
    LabDevice bus{.where = {},
                  .name = std::string{device->name},
                  .device = device,
                  .target = {target_of(nodes), "emulated", {}, nodes},
                  .places = {}};
    bus.places.bus = options.number;
    bus.capture = options.capture;
    bus.wants_check = options.wants_check;
    return std::vector{std::move(bus)};
  });
}

Exit exec(Devices devices, const ExecOptions& options) {
  const bool is_bus = !options.nodes.empty();
  auto program = options.program;
  if (is_bus && !options.lab.empty()) program.insert(program.begin(), options.lab);
  if (program.empty()) {
    return report(is_bus ? Problem{ErrorCode::kBadValue, "PROGRAM is missing", "write it behind --"}
                         : Problem{ErrorCode::kBadValue, "LAB.toml or PROGRAM is missing",
                                   "write armjig lab exec LAB.toml -- PROGRAM, or --i2c NODES.toml "
                                   "for a bus alone"});
  }
  auto plans = is_bus ? lab_of_bus(devices, options) : read_lab(options.lab, devices);
  if (!plans) return report(plans.error());
  const auto files = ReportOutputs::open(options.files, "PROGRAM");
  if (!files) return report(files.error());
  const auto lab = open_lab(*std::move(plans));
  if (!lab) return report(lab.error());
  const auto code =
      ServedDevices::open(lab->to_serve()).and_then([&](const auto& served) -> Outcome<int> {
        return run_program(program, served->environment());
      });
  if (!code) return report(code.error());
  const auto ended = static_cast<Exit>(*code);
  const auto judged = judge(*lab, [&](const std::string& name, const Report& result) {
    if (lab->all.size() > 1) fmt::print(stderr, "{}:\n", name);
    fmt::print(stderr, "{}\n", to_text(result, style_of(options.colour, stderr)));
    files->put(result);
  });
  const auto gone = tell_gone(*lab);
  if (ended != Exit::kPassed) return ended;
  if (judged == Exit::kFindings) return *judged;
  return gone.value_or(judged.value_or(ended));
}

void add_up(CLI::App& lab, Devices devices, Action& action) {
  auto* command = lab.add_subcommand("up", with_example(kUpHelp, devices));
  const auto options = std::make_shared<UpOptions>();
  command->add_option("LAB", options->lab, "the devices")->type_name("")->required();
  command->add_flag("--json", options->wants_json,
                    "say where they listen as one line of JSON; reports too");
  add_colour_option(*command, options->colour);
  when_chosen(*command, action, [options, devices] { return up(devices, *options); });
}

void add_exec(CLI::App& lab, Devices devices, Action& action) {
  auto* command = lab.add_subcommand("exec", kExecHelp);
  const auto options = std::make_shared<ExecOptions>();
  auto* nodes = command->add_option("--i2c", options->nodes, "the devices of an I2C bus alone")
                    ->type_name("NODES.toml");
  command->add_option("--bus", options->number, "its number, 0 to 255 (default: 1)")
      ->type_name("N")
      ->transform(whole(0, 255))
      ->needs(nodes);
  add_capture_options(*command, options->capture)->needs(nodes);
  auto* check =
      command->add_flag("--check", options->wants_check, "judge the program")->needs(nodes);
  for (auto* file : add_report_files(*command, options->files)) file->needs(check);
  add_colour_option(*command, options->colour);
  command->add_option("LAB", options->lab, "the devices, unless there is --i2c")->type_name("");
  command->add_option("PROGRAM", options->program, "and its arguments, behind --")->type_name("");
  when_chosen(*command, action, [options, devices] { return exec(devices, *options); });
}

}  // namespace

void add_lab(CLI::App& app, Devices devices, Action& action) {
  auto* lab = app.add_subcommand("lab", kLabHelp);
  lab->require_subcommand(1);
  add_up(*lab, devices, action);
  add_exec(*lab, devices, action);
}

}  // namespace armjig::cli
