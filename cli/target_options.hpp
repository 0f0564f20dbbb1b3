// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "cli/capture_options.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::cli {

/// What every subcommand with a target is told about it, as written.
struct TargetOptions {
  std::string target;
  std::string allow;
  std::string impair;
  CaptureOptions capture;
};

/// Adds `--target`, `--allow`, `--impair`, `--capture`, `--rotate` and `--redact`. None is required
/// here: `parse_target_options` says in its own words that the target is missing.
void add_target_options(CLI::App& app, TargetOptions& options);

/// Adds `--impair` and those of the recording alone.
void add_link_options(CLI::App& app, TargetOptions& options);

/// Reads the options, and opens the recording.
[[nodiscard]] Outcome<RigOptions> parse_target_options(const TargetOptions& options);

/// What a command line needs besides the target to meet it in the same way again, for a report;
/// begins with a blank unless it is empty. The recording is left out.
[[nodiscard]] std::string to_arguments(const TargetOptions& options);

}  // namespace armjig::cli
