// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "conformance/program_checker.hpp"
#include "conformance/requirement.hpp"

namespace armjig::parol6::programs {

/// What is demanded of the programs at the other end.
[[nodiscard]] std::span<const Requirement> host_requirements() noexcept;

/// Judges a program from the power-up of a board on.
[[nodiscard]] ProgramCheckEntry program_check() noexcept;

}  // namespace armjig::parol6::programs
