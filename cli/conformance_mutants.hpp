// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/command.hpp"

namespace armjig::cli {

/// Adds `mutants` to the subcommand `conformance`.
void add_conformance_mutants(CLI::App& conformance, Devices devices, Action& action);

}  // namespace armjig::cli
