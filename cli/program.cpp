// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/candidates.hpp"
#include "cli/checks.hpp"
#include "cli/choice.hpp"
#include "cli/device.hpp"
#include "cli/diff.hpp"
#include "cli/outputs.hpp"
#include "cli/terminal.hpp"
#include "harness/core/version.hpp"
#include "harness/report/wording.hpp"

namespace armjig::cli {
namespace {

constexpr std::array kCommands{add_captures, add_conformance, add_console,   add_decode,
                               add_devices,  add_diff,        add_doctor,    add_emulate,
                               add_fuzz,     add_kin,         add_lab,       add_latency,
                               add_record,   add_replay,      add_shadow,    add_trace,
                               add_watch,    add_wireshark,   add_completion};

constexpr auto kDescription =
    "Test jig for robot-arm controllers and the programs that drive them.\n"
    "\n"
    "  armjig emulate DEVICE                          an emulated device, for your program\n"
    "  armjig conformance DEVICE --target emulated:   is that device right?\n"
    "  armjig trace verify captures                   replay recordings of real devices\n"
    "  armjig decode DEVICE --file session.bin        what do these bytes mean?\n"
    "  armjig console DEVICE --target emulated:       drive it by hand\n";

constexpr auto kFooter =
    "Exit codes: 0 passed, 1 findings, 2 usage, 3 target, link or output, 4 nothing ran, 70 our "
    "bug, 130 "
    "interrupted.\n"
    "'armjig SUBCOMMAND --help' has examples.";

/// In the list of subcommands, only the first line of each description: its examples belong to its
/// own help. All of it is as wide as the terminal.
class HelpText final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    return wrapped(Formatter::make_help(app, std::move(name), mode), help_width());
  }

  std::string make_subcommand(const CLI::App* sub) const override {
    const auto description = sub->get_description();
    return fmt::format("  {:<12} {}\n", sub->get_name(),
                       description.substr(0, description.find('\n')));
  }
};

/// The last of the subcommands that were understood.
const CLI::App& chosen_of(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? app : chosen_of(*chosen.front());
}

/// The command as far as it was understood: `armjig trace verify`.
std::string call_of(const CLI::App& app) {
  const auto* const parent = app.get_parent();
  return parent == nullptr ? app.get_name()
                           : fmt::format("{} {}", call_of(*parent), app.get_name());
}

/// What is wrong with the command line. Words that nothing takes are told before what is missing,
/// for they may be what was meant.
std::string complaint_of(const CLI::App& command, const CLI::ParseError& error) {
  const auto code = static_cast<CLI::ExitCodes>(error.get_exit_code());
  const bool may_be_of_rest =
      code == CLI::ExitCodes::ExtrasError || code == CLI::ExitCodes::RequiredError;
  const auto rest = may_be_of_rest ? complaint_of_rest(command) : "";
  return wording::line(rest.empty() ? fmt::format("{}; ", error.what()) : rest);
}

/// CLI11's own codes start at 100; ours are fixed.
Exit exit_of(const CLI::App& app, const CLI::ParseError& error) {
  const bool is_help = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
  if (is_help) {
    std::ostringstream text;
    app.exit(error, text, text);
    fmt::print("{}", text.str());
    return Exit::kPassed;
  }
  const auto& command = chosen_of(app);
  fmt::print(stderr, "armjig: {}see '{} --help'\n", complaint_of(command, error), call_of(command));
  return Exit::kUsage;
}

/// An entry that is not complete is found out before a subcommand meets it.
void check(Devices devices) {
  for (const auto& device : devices) {
    const auto missing = missing_parts(device);
    if (!missing.empty()) {
      throw std::logic_error{
          fmt::format("the entry of '{}' lacks {}", device.name, missing.front())};
    }
  }
}

// What shells and tests ask the program for; people see neither.
constexpr auto kAskedToComplete = "__complete";
constexpr auto kAskedForCommands = "__commands";

/// Every subcommand below `command` with the names of its arguments and options, as docs/cli.md has
/// it.
void print_commands(const CLI::App& command) {
  for (const auto* sub : subcommands_of(command)) {
    std::string names;
    for (const auto* option : sub->get_options()) {
      if (option->get_name() != "--help") names += fmt::format(" `{}`", option->get_name());
    }
    if (subcommands_of(*sub).empty() || !names.empty()) {
      fmt::print("- `{}`{}{}\n", call_of(*sub), names.empty() ? "" : ":", names);
    }
    print_commands(*sub);
  }
}

Exit run(int argc, char** argv, Devices devices) {
  check(devices);
  CLI::App app{with_example(kDescription, devices), "armjig"};
  app.footer(kFooter);
  app.formatter(std::make_shared<HelpText>());
  app.set_version_flag("--version", std::string{"armjig "} + kVersion);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  Action action;
  for (const auto add : kCommands) add(app, devices, action);
  for (const auto& device : devices) {
    for (const auto add : device.commands) add(app, device, action);
  }
  refuse_empty_texts(app);
  const std::vector<std::string> words{argv + std::min(argc, 1), argv + argc};
  if (!words.empty() && words.front() == kAskedToComplete) {
    for (const auto& word : candidates(app, devices, std::span{words}.subspan(1))) {
      fmt::print("{}\n", word);
    }
    return Exit::kPassed;
  }
  if (!words.empty() && words.front() == kAskedForCommands) {
    print_commands(app);
    return Exit::kPassed;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return exit_of(app, error);
  }
  return action();
}

}  // namespace

Exit report(const Problem& problem) {
  fmt::print(stderr, "armjig: {}\n", wording::line(describe(problem)));
  switch (problem.code) {
    case ErrorCode::kBadHex:
    case ErrorCode::kOddHex:
    case ErrorCode::kBadTarget:
    case ErrorCode::kUnknownDevice:
    case ErrorCode::kUnknownOption:
    case ErrorCode::kBadValue:
    case ErrorCode::kMalformed:
    case ErrorCode::kUnsupported:
    case ErrorCode::kCannotRead:
      return Exit::kUsage;
    default:
      return Exit::kRig;
  }
}

Exit refuse(const Problem& problem) {
  (void)report(problem);
  return Exit::kUsage;
}

void when_chosen(CLI::App& command, Action& action, Action what) {
  command.callback([&action, what = std::move(what)] { action = what; });
}

void add_device_argument(CLI::App& command, std::string& device, Devices devices) {
  command.add_option("DEVICE", device, "which one: " + names_of(devices))
      ->required()
      ->type_name("");
}

std::string with_example(std::string text, Devices devices) {
  constexpr std::string_view kPlace = "DEVICE";
  const std::string name{devices.empty() ? "none" : devices.front().name};
  for (auto at = text.find(kPlace); at != std::string::npos; at = text.find(kPlace, at)) {
    text.replace(at, kPlace.size(), name);
  }
  return text;
}

int run_program(int argc, char** argv, Devices devices) {
  Outputs outputs;
  auto exit = Exit::kBug;
  try {
    exit = run(argc, argv, devices);
  } catch (const std::exception& error) {
    fmt::print(stderr, "armjig: internal error: {}; please report it\n", error.what());
  }
  return static_cast<int>(outputs.finish(exit));
}

}  // namespace armjig::cli
