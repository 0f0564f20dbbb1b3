// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "conformance/program_checker.hpp"
#include "conformance/requirement.hpp"

namespace armjig::morap::programs {

/// What is demanded of the programs at the other end.
[[nodiscard]] std::span<const Requirement> host_requirements() noexcept;

/// Judges a master from the power-up of its bus on. It is shown one transaction a call, as the
/// dissector is: the byte with address and direction, then the data bytes that were acknowledged;
/// writes by `to_device`, reads by `from_device`.
[[nodiscard]] ProgramCheckEntry program_check() noexcept;

}  // namespace armjig::morap::programs
