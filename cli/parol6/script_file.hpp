// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "cli/command.hpp"
#include "harness/core/error.hpp"
#include "harness/motion/parol6/planner.hpp"
#include "harness/script/interpreter.hpp"
#include "harness/script/program.hpp"

namespace armjig::cli {

/// A program on disk and in which dialect it is, as written.
struct ScriptOptions {
  std::string file;
  std::string dialect = "documented";
};
void add_script_options(CLI::App& app, ScriptOptions& options);

[[nodiscard]] script::Dialect dialect_of(const ScriptOptions& options);

/// The file's text, or more than a program may have of it; `-` is standard input.
[[nodiscard]] Outcome<std::string> read_script_text(const ScriptOptions& options);

/// Reads a program. What is wrong with it is printed, and answers the exit code.
[[nodiscard]] tl::expected<script::Program, Exit> read_script(const ScriptOptions& options);

/// All that is wrong with a text that cannot be read, and which dialect would read it.
[[nodiscard]] std::vector<script::Diagnostic> with_advice(std::vector<script::Diagnostic> errors,
                                                          const std::string& text,
                                                          const ScriptOptions& options);

/// Prints them on standard error, a line each; nothing of less than `least`.
void print_diagnostics(const std::vector<script::Diagnostic>& diagnostics, const std::string& file,
                       script::Severity least = script::Severity::kNote);

/// How a program is planned, as written.
struct PlanningOptions {
  std::string on_singularity = "stop";
  std::string orientation = "commander";
  std::uint64_t loops = 1;
  int gripper_id = 0;
  std::string from = "standby";
};
void add_planning_options(CLI::App& app, PlanningOptions& options);

/// The same, read.
struct Planning {
  script::InterpreterSettings settings;
  parol6::JointSteps start{};
};
[[nodiscard]] Outcome<Planning> parse_planning(const PlanningOptions& options);

}  // namespace armjig::cli
