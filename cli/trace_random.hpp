// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/command.hpp"

namespace armjig::cli {

/// Adds `trace random`, which writes recordings of sessions drawn at random.
void add_trace_random(CLI::App& trace, Devices devices, Action& action);

}  // namespace armjig::cli
