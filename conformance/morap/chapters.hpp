// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "conformance/suite.hpp"

/// The chapters of the MORAP suite: requirements in catalogue/, cases in cases/.
namespace armjig::morap::conformance {

[[nodiscard]] std::span<const Requirement> bus_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> reading_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> status_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> reference_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> output_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> program_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> tune_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> loop_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> motion_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> documented_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> pen_requirements() noexcept;
/// Of programs.

[[nodiscard]] std::span<const Case> bus_cases() noexcept;
[[nodiscard]] std::span<const Case> reading_cases() noexcept;
[[nodiscard]] std::span<const Case> status_cases() noexcept;
[[nodiscard]] std::span<const Case> reference_cases() noexcept;
[[nodiscard]] std::span<const Case> output_cases() noexcept;
[[nodiscard]] std::span<const Case> program_cases() noexcept;
[[nodiscard]] std::span<const Case> tune_cases() noexcept;
[[nodiscard]] std::span<const Case> loop_cases() noexcept;
[[nodiscard]] std::span<const Case> motion_cases() noexcept;
[[nodiscard]] std::span<const Case> documented_cases() noexcept;

}  // namespace armjig::morap::conformance
