// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "cli/device.hpp"

/// The subcommands that only MORAP nodes have: controllers, and single transactions on their bus.
namespace armjig::cli {

void add_i2c(CLI::App& app, const Device& device, Action& action);
void add_morap(CLI::App& app, const Device& device, Action& action);

/// Adds `simulate` to the subcommands of `morap`.
void add_morap_simulate(CLI::App& morap, Action& action);

}  // namespace armjig::cli
