// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/command.hpp"

namespace armjig::cli {

/// Adds `info`, `show`, `convert`, `cut` and `merge` below `trace`.
void add_trace_files(CLI::App& trace, Devices devices, Action& action);

}  // namespace armjig::cli
