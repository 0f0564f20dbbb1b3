// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/command.hpp"

namespace armjig::cli {

/// Adds `trace what-if`.
void add_trace_what_if(CLI::App& trace, Devices devices, Action& action);

}  // namespace armjig::cli
