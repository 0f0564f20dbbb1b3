// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <memory>
#include <string>

#include "cli/choice.hpp"
#include "cli/morap/arguments.hpp"
#include "cli/morap/bus_session.hpp"
#include "cli/morap/commands.hpp"
#include "emulators/morap/tuner.hpp"
#include "harness/core/hex.hpp"
#include "harness/drive/morap/joint.hpp"
#include "harness/drive/morap/parameter_file.hpp"

namespace armjig::cli {
namespace {

using namespace morap;
using namespace morap::drive;

constexpr auto kMorapHelp =
    "Controllers of MORAP motor nodes: compute, program, read back, simulate.\n"
    "\n"
    "  armjig morap tune --type pd --inertia 0.2 --pole -9 > joint2.toml    as the node computes "
    "it\n"
    "  armjig morap tune --type pd --inertia 0.2 --pole -9 --target i2c:/dev/i2c-1 --node 2 "
    "--allow program\n"
    "  armjig morap program joint2.toml --target i2c:/dev/i2c-1 --node 2 --allow program\n"
    "  armjig morap read-params --target i2c:/dev/i2c-1 --node 2\n"
    "  armjig morap simulate --params joint2.toml --inertia 0.2 --step 0.5 --html step.html\n"
    "\n"
    "Programming and tuning disable the motor, load the defaults of both controllers and verify "
    "by\n"
    "status and read-back. Controllers are lost when the node loses its power.\n"
    "\n"
    "Exit codes: 0 done, 1 the node refuses or shows something else, 2 wrong arguments or file, 3 "
    "no\n"
    "such bus or node.";

struct MorapOptions {
  TargetOptions target;
  std::uint8_t node = 2;
  std::string motor{morap::kDcx22l.name};
  TuneArguments tuning;
  std::string file;
  std::string controller = "both";
};

BusAddress address_of(const MorapOptions& options) { return {node_address(options.node)}; }

std::string hex_of(const Command& command) { return to_hex(encode(command).view()); }

Exit conclude(const ProgramResult& result, const MorapOptions& options, const Rig<BusPort>& rig) {
  switch (result.outcome) {
    case ProgramOutcome::kDone:
      fmt::print("{}", to_toml(result.active));
      return Exit::kPassed;
    case ProgramOutcome::kBusFailed:
      return report(result.code, address_of(options), rig);
    default:
      fmt::print(stderr, "armjig: node {}: {}\n", options.node, describe(result.outcome));
      return Exit::kFindings;
  }
}

template <class Work>
Exit with_joint(const Device& device, const MorapOptions& options, Work work) {
  auto rig = open_bus_rig(device, options.target);
  if (!rig) return report(rig.error());
  Master master{rig->port()};
  Joint joint{master, address_of(options)};
  return work(joint, *rig);
}

/// Nobody programs a motor that turns.
template <class Work>
Exit with_disabled_joint(const Device& device, const MorapOptions& options, Work work) {
  return with_joint(device, options, [&](Joint& joint, const Rig<BusPort>& rig) {
    const auto code = joint.disable();
    if (code != BusCode::kOk) return report(code, joint.address(), rig);
    return conclude(work(joint), options, rig);
  });
}

Exit tune_node(const Device& device, const MorapOptions& options) {
  return with_disabled_joint(
      device, options, [&options](Joint& joint) { return joint.tune(options.tuning.request()); });
}

Exit tune(const Device& device, const MorapOptions& options) {
  const auto request = options.tuning.request();
  if (const auto refusal = refusal_of(request); !refusal.empty()) {
    return report({ErrorCode::kBadValue, "--inertia, --pole", refusal});
  }
  if (!options.target.target.empty()) return tune_node(device, options);
  const auto set =
      morap::emulation::tune(request, eeprom_of(options.motor).motor, morap::emulation::kFirmware);
  if (!set) return report({ErrorCode::kBadValue, "--inertia, --pole", "the node refuses them"});
  fmt::print("# {}, {} kg m^2, pole {} 1/s, motor {}\n", options.tuning.type,
             options.tuning.inertia, options.tuning.pole, options.motor);
  fmt::print("# tuning message  {}\n", hex_of({CommandId::kTune, request}));
  fmt::print("# program message {}\n{}", hex_of({CommandId::kProgram, *set}), to_toml(*set));
  return Exit::kPassed;
}

Exit program(const Device& device, const MorapOptions& options) {
  const auto set = read_parameters(options.file);
  if (!set) return report(set.error());
  if (!is_safe(*set)) {
    return report(
        {ErrorCode::kBadValue, options.file, std::string{describe(ProgramOutcome::kUnsafe)}});
  }
  return with_disabled_joint(device, options, [&set](Joint& joint) { return joint.program(*set); });
}

Exit read_parameters_of(Joint& joint, ControllerKind kind, const Rig<BusPort>& rig) {
  const auto bytes = joint.controller_set(kind);
  if (bytes.code != BusCode::kOk) return report(bytes.code, joint.address(), rig);
  ControllerSet set;
  if (decode_into(set, bytes.value.view())) {
    fmt::print(stderr, "armjig: address 0x{:02X}: what was read is no set of parameters\n",
               joint.address().value);
    return Exit::kFindings;
  }
  fmt::print("# read            {}\n{}", to_hex(bytes.value.view()), to_toml(set));
  return Exit::kPassed;
}

Exit read_params(const Device& device, const MorapOptions& options) {
  return with_joint(device, options, [&](Joint& joint, const Rig<BusPort>& rig) {
    if (options.controller != "speed") {
      const auto done = read_parameters_of(joint, ControllerKind::kPosition, rig);
      if (done != Exit::kPassed || options.controller == "position") return done;
      fmt::print("\n");
    }
    return read_parameters_of(joint, ControllerKind::kSpeed, rig);
  });
}

using Run = Exit (*)(const Device& device, const MorapOptions& options);

/// What all that is done to a node have, last of their options.
void add_to_node(CLI::App& command, const std::shared_ptr<MorapOptions>& options,
                 const Device& device, Action& action, Run run) {
  add_target_options(command, options->target);
  add_node_option(command, options->node);
  when_chosen(command, action, [options, run, &device] { return run(device, *options); });
}

void add_tune(CLI::App& morap, const Device& device, Action& action) {
  auto* command = morap.add_subcommand(
      "tune", "Computes a controller bit for bit as a node does, or lets a node do it.");
  const auto options = std::make_shared<MorapOptions>();
  const auto added = add_tune_options(*command, options->tuning);
  for (auto* option : {added.type, added.inertia, added.pole}) option->required();
  add_motor_option(*command, options->motor);
  add_to_node(*command, options, device, action, tune);
}

void add_program(CLI::App& morap, const Device& device, Action& action) {
  auto* command = morap.add_subcommand("program", "Brings the controller of a file into a node.");
  const auto options = std::make_shared<MorapOptions>();
  command->add_option("FILE", options->file, "as 'morap tune' and 'morap read-params' write it")
      ->required()
      ->type_name("");
  add_to_node(*command, options, device, action, program);
}

void add_read_params(CLI::App& morap, const Device& device, Action& action) {
  auto* command = morap.add_subcommand("read-params", "Shows the active controllers of a node.");
  const auto options = std::make_shared<MorapOptions>();
  command->add_option("--controller", options->controller, "which of them")
      ->check(one_of({"position", "speed", "both"}))
      ->capture_default_str();
  add_to_node(*command, options, device, action, read_params);
}

}  // namespace

void add_morap(CLI::App& app, const Device& device, Action& action) {
  auto* morap = app.add_subcommand("morap", kMorapHelp);
  morap->require_subcommand(1);
  add_tune(*morap, device, action);
  add_program(*morap, device, action);
  add_read_params(*morap, device, action);
  add_morap_simulate(*morap, action);
}

}  // namespace armjig::cli
