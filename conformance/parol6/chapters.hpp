// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "conformance/suite.hpp"

/// The chapters of the PAROL6 suite: requirements in catalogue/, cases in cases/.
namespace armjig::parol6::conformance {

[[nodiscard]] std::span<const Requirement> frame_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> receive_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> telemetry_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> io_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> command_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> jog_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> go_to_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> home_run_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> home_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> demo_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> gripper_requirements() noexcept;
/// Of programs.

[[nodiscard]] std::span<const Case> frame_cases() noexcept;
[[nodiscard]] std::span<const Case> receive_cases() noexcept;
[[nodiscard]] std::span<const Case> telemetry_cases() noexcept;
[[nodiscard]] std::span<const Case> io_cases() noexcept;
[[nodiscard]] std::span<const Case> command_cases() noexcept;
[[nodiscard]] std::span<const Case> jog_cases() noexcept;
[[nodiscard]] std::span<const Case> go_to_cases() noexcept;
[[nodiscard]] std::span<const Case> home_cases() noexcept;
[[nodiscard]] std::span<const Case> home_run_cases() noexcept;
[[nodiscard]] std::span<const Case> demo_cases() noexcept;
[[nodiscard]] std::span<const Case> gripper_cases() noexcept;
[[nodiscard]] std::span<const Case> between_cases() noexcept;

}  // namespace armjig::parol6::conformance
