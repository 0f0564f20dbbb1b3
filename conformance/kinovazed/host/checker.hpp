// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "conformance/program_checker.hpp"
#include "conformance/requirement.hpp"

namespace armjig::kinovazed {

/// What a program has to do that is a client of the server.
[[nodiscard]] std::span<const Requirement> host_requirements() noexcept;

/// Judges the clients of a server from the start of its process on. Whether that is the shipped or
/// the documented one makes no difference: of what the two answer differently nothing depends.
[[nodiscard]] std::unique_ptr<ProgramChecker> make_host_checker(const LinkNoise& noise = {});

}  // namespace armjig::kinovazed
