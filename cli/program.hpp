// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/command.hpp"

namespace armjig::cli {

/// The whole program with all its subcommands, for these devices and no others: what `main` calls.
/// Answers the exit code. An entry that is not complete is exit code 70.
[[nodiscard]] int run_program(int argc, char** argv, Devices devices);

}  // namespace armjig::cli
