// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "harness/core/error.hpp"

namespace armjig {

/// Runs a program with `environment` added to ours, and waits for its end. Interrupts of the
/// terminal are for the program; SIGTERM and SIGHUP to us are handed on to it. Its exit code, or
/// 128 and the number of the signal that ended it. Problems: `kNotFound`, `kNoPermission`,
/// `kSystem`. Requires a name; one call at a time in a process.
[[nodiscard]] Outcome<int> run_program(const std::vector<std::string>& arguments,
                                       const std::vector<std::string>& environment);

}  // namespace armjig
