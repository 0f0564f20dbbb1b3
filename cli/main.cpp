// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <exception>
#include <memory>
#include <string>
#include <string_view>

#include "cli/command.hpp"
#include "harness/core/version.hpp"

namespace armjig::cli {
namespace {

constexpr std::array kCommands{add_conformance, add_console, add_decode, add_devices,
                               add_doctor,      add_emulate, add_i2c,    add_kin,
                               add_lab,         add_morap,   add_plan,   add_run,
                               add_script,      add_trace,   add_watch,  add_completion};

constexpr auto kDescription =
    "Test jig for robot-arm controllers and the programs that drive them.\n"
    "\n"
    "  armjig emulate parol6 --link /tmp/parol6       an emulated board on a pseudo-terminal\n"
    "  armjig conformance parol6 --target pty:/tmp/parol6   is that board right?\n"
    "  armjig trace verify captures                   replay recordings of real devices\n"
    "  armjig decode parol6 FFFFFF34...               what do these bytes mean?\n"
    "  armjig console parol6 --target emulated:       drive an arm by hand\n";

constexpr auto kFooter =
    "Exit codes: 0 passed, 1 findings, 2 usage, 3 target or link, 4 nothing ran, 70 our bug, 130 "
    "interrupted.\n"
    "'armjig SUBCOMMAND --help' has examples.";

/// In the list of subcommands, only the first line of each description: its examples belong to its
/// own help.
class FirstLines final : public CLI::Formatter {
 public:
  std::string make_subcommand(const CLI::App* sub) const override {
    const auto description = sub->get_description();
    return fmt::format("  {:<12} {}\n", sub->get_name(),
                       description.substr(0, description.find('\n')));
  }
};

bool is_option(std::string_view word) { return word.starts_with('-'); }

bool has_subcommand(const CLI::App& app, std::string_view name) {
  return !app.get_subcommands([name](const CLI::App* sub) { return sub->get_name() == name; })
              .empty();
}

std::string names(const CLI::App& app) {
  std::string names;
  for (const auto* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    names += ' ' + sub->get_name();
  }
  return names;
}

/// CLI11's own codes start at 100; ours are fixed.
Exit exit_of(const CLI::App& app, const CLI::ParseError& error) {
  const bool is_help = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
  if (is_help) {
    app.exit(error);
    return Exit::kPassed;
  }
  fmt::print(stderr, "armjig: {}; see 'armjig --help'\n", error.what());
  return Exit::kUsage;
}

Exit run(int argc, char** argv) {
  CLI::App app{kDescription, "armjig"};
  app.footer(kFooter);
  app.formatter(std::make_shared<FirstLines>());
  app.set_version_flag("--version", std::string{"armjig "} + kVersion);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  Action action;
  for (const auto add : kCommands) add(app, action);
  if (argc > 1 && !is_option(argv[1]) && !has_subcommand(app, argv[1])) {
    fmt::print(stderr, "armjig: there is no subcommand '{}'; there are:{}\n", argv[1], names(app));
    return Exit::kUsage;
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
  fmt::print(stderr, "armjig: {}\n", describe(problem));
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

}  // namespace armjig::cli

int main(int argc, char** argv) {
  try {
    return static_cast<int>(armjig::cli::run(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "armjig: internal error: {}; please report it\n", error.what());
    return static_cast<int>(armjig::cli::Exit::kBug);
  }
}
