// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

#include "harness/core/time.hpp"

/// What the values of options have to be, in one place for all subcommands. CLI11's own ranges take
/// `nan`, wrap negative numbers and read 010 as eight.
namespace armjig::cli {

/// A whole number, decimal or as in 0x12; to be given to `transform`.
[[nodiscard]] CLI::Validator whole(std::int64_t least, std::uint64_t most);

/// A finite number.
[[nodiscard]] CLI::Validator number(double least, double most);

/// What a number of seconds means; it reaches 292 years.
[[nodiscard]] inline Duration duration_of(double seconds) {
  return std::chrono::round<Duration>(std::chrono::duration<double>{seconds});
}

/// Lets no option of the command and its subcommands take an empty text, which is what a variable
/// of a shell that was never set leaves there. Words of another program are its own.
void refuse_empty_texts(CLI::App& command);

}  // namespace armjig::cli
