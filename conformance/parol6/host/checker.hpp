// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "conformance/program_checker.hpp"
#include "conformance/requirement.hpp"

namespace armjig::parol6 {

/// What a program has to do that talks to the board.
[[nodiscard]] std::span<const Requirement> host_requirements() noexcept;

/// Judges a program from the power-up of a board on.
[[nodiscard]] std::unique_ptr<ProgramChecker> make_host_checker(const LinkNoise& noise = {});

}  // namespace armjig::parol6
