// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "conformance/suite.hpp"

/// The chapters of the PAROL6 suite: requirements in catalogue/, cases in cases/.
namespace armjig::parol6 {

[[nodiscard]] std::span<const Requirement> frame_requirements() noexcept;
[[nodiscard]] std::span<const Case> frame_cases() noexcept;

[[nodiscard]] std::span<const Requirement> telemetry_requirements() noexcept;
[[nodiscard]] std::span<const Case> telemetry_cases() noexcept;

}  // namespace armjig::parol6
