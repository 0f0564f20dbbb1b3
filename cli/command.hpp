// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "harness/core/error.hpp"

namespace armjig::cli {

/// The exit codes of every subcommand (docs/cli.md).
enum class Exit : int {
  kPassed = 0,    ///< at least one thing ran, all passed or deviated as known
  kFindings = 1,  ///< something failed or differs
  kUsage = 2,     ///< wrong arguments or unreadable input
  kRig = 3,       ///< the target is absent, busy, forbidden or silent
  kNothing = 4,   ///< nothing was selected or nothing ran
  kBug = 70,      ///< ours
  kInterrupted = 130,
};

/// What a subcommand does once its arguments are parsed.
using Action = std::function<Exit()>;

/// Adds a subcommand to `app`. When it is the one chosen, `action` is set to what it does.
using AddCommand = void (*)(CLI::App& app, Action& action);

void add_completion(CLI::App& app, Action& action);
void add_conformance(CLI::App& app, Action& action);
void add_console(CLI::App& app, Action& action);
void add_decode(CLI::App& app, Action& action);
void add_devices(CLI::App& app, Action& action);
void add_doctor(CLI::App& app, Action& action);
void add_emulate(CLI::App& app, Action& action);
void add_i2c(CLI::App& app, Action& action);
void add_kin(CLI::App& app, Action& action);
void add_lab(CLI::App& app, Action& action);
void add_morap(CLI::App& app, Action& action);
void add_plan(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_script(CLI::App& app, Action& action);
void add_trace(CLI::App& app, Action& action);
void add_watch(CLI::App& app, Action& action);

/// Prints the problem as one line on standard error and answers the exit code that goes with it.
[[nodiscard]] Exit report(const Problem& problem);

}  // namespace armjig::cli
