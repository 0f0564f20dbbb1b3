// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/command.hpp"

namespace armjig::cli {

/// Adds `simulate` to the subcommands of `morap`.
void add_morap_simulate(CLI::App& morap, Action& action);

}  // namespace armjig::cli
