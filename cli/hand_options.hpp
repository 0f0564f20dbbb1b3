// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "conformance/bench.hpp"

namespace armjig::cli {

/// Commands for the shell that do at a device what its link cannot.
struct HandOptions {
  std::string hand;
  std::string restart;
  std::string power_cycle;
};

/// Adds `--hand`, `--restart` and `--power-cycle`.
void add_hand_options(CLI::App& app, HandOptions& options);

/// Runs the commands when a case asks for it; one that ends well has done it.
[[nodiscard]] Hand hand_of(const HandOptions& options);

/// Begins with a blank unless it is empty.
[[nodiscard]] std::string to_arguments(const HandOptions& options);

}  // namespace armjig::cli
