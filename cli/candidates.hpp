// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "cli/command.hpp"

namespace armjig::cli {

/// What may be typed for the last of `words`, which may be empty and may begin with a quote: those
/// of subcommands, options, devices, targets and other names that begin with it. `words` are what
/// stands after the program's name. Nothing: it may be anything, such as a file.
[[nodiscard]] std::vector<std::string> candidates(const CLI::App& app, Devices devices,
                                                  std::span<const std::string> words);

}  // namespace armjig::cli
