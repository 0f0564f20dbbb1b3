// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// Runs a program with `environment` added to ours, and waits for its end. Interrupts of the
/// terminal are for the program; SIGTERM and SIGHUP to us are handed on to it. Its exit code, or
/// 128 and the number of the signal that ended it. Problems: `kNotFound`, `kNoPermission`,
/// `kSystem`. Requires a name; one call at a time in a process.
[[nodiscard]] Outcome<int> run_program(const std::vector<std::string>& arguments,
                                       const std::vector<std::string>& environment);

/// The same in silence and for no longer than `patience`, after which it is killed: none. It has no
/// input, nobody sees what it writes, and signals to us are not handed on. Many at a time.
[[nodiscard]] Outcome<std::optional<int>> run_program_silently(
    const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
    Duration patience);

}  // namespace armjig
