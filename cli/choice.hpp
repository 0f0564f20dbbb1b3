// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace armjig::cli {

/// Lets an option have one of these words. Help shows them, and completion offers them.
[[nodiscard]] CLI::Validator one_of(std::vector<std::string> words);

/// The words between which `one_of` lets the option choose; none if it may be anything.
[[nodiscard]] std::vector<std::string> choices_of(const CLI::Option& option);

/// What is wrong with the words of a command line that no part of `command` takes; empty if there
/// are none.
[[nodiscard]] std::string complaint_of_rest(const CLI::App& command);

/// The subcommands of `command` that users are told of.
[[nodiscard]] std::vector<const CLI::App*> subcommands_of(const CLI::App& command);

}  // namespace armjig::cli
