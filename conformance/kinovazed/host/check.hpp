// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "conformance/program_checker.hpp"
#include "conformance/requirement.hpp"

namespace armjig::kinovazed::programs {

/// What is demanded of the programs at the other end.
[[nodiscard]] std::span<const Requirement> host_requirements() noexcept;

/// Judges the clients of a server from the start of its process on. Whether that is the shipped or
/// the documented one makes no difference: of what the two answer differently nothing depends.
[[nodiscard]] ProgramCheckEntry program_check() noexcept;

}  // namespace armjig::kinovazed::programs
