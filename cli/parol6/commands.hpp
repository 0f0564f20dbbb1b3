// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "cli/device.hpp"

/// The subcommands that only a PAROL6 has: programs in RBTscript.
namespace armjig::cli {

void add_plan(CLI::App& app, const Device& device, Action& action);
void add_run(CLI::App& app, const Device& device, Action& action);
void add_script(CLI::App& app, const Device& device, Action& action);

}  // namespace armjig::cli
