// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/command.hpp"

/// How Wireshark starts a program that captures: once for each question, and once to capture.
namespace armjig::cli {

/// Adds `extcap`, which answers Wireshark's questions and records into its pipe.
void add_extcap(CLI::App& wireshark, Devices devices, Action& action);

/// What Wireshark finds in its folder: a script that starts the armjig at that path.
[[nodiscard]] std::string extcap_script(const std::string& program);

}  // namespace armjig::cli
