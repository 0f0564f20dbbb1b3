// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "conformance/program_checker.hpp"
#include "conformance/requirement.hpp"

namespace armjig::morap {

/// What a program has to do that is the master of a bus with nodes and the pen.
[[nodiscard]] std::span<const Requirement> host_requirements() noexcept;

/// Judges a master from the power-up of its bus on. It is shown one transaction a call, as the
/// dissector is: the byte with address and direction, then the data bytes that were acknowledged;
/// writes by `to_device`, reads by `from_device`.
[[nodiscard]] std::unique_ptr<ProgramChecker> make_host_checker(const LinkNoise& noise = {});

}  // namespace armjig::morap
