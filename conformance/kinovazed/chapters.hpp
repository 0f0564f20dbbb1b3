// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "conformance/suite.hpp"

/// The chapters of the KinovaZED suite: requirements in catalogue/, cases in cases/.
namespace armjig::kinovazed::conformance {

[[nodiscard]] std::span<const Requirement> connection_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> line_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> long_line_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> state_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> reply_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> interrupt_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> beat_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> joystick_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> objective_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> arm_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> robust_requirements() noexcept;
[[nodiscard]] std::span<const Requirement> death_requirements() noexcept;
/// Of programs.

[[nodiscard]] std::span<const Case> connection_cases() noexcept;
[[nodiscard]] std::span<const Case> line_cases() noexcept;
[[nodiscard]] std::span<const Case> long_line_cases() noexcept;
[[nodiscard]] std::span<const Case> state_cases() noexcept;
[[nodiscard]] std::span<const Case> reply_cases() noexcept;
[[nodiscard]] std::span<const Case> interrupt_cases() noexcept;
[[nodiscard]] std::span<const Case> beat_cases() noexcept;
[[nodiscard]] std::span<const Case> joystick_cases() noexcept;
[[nodiscard]] std::span<const Case> objective_cases() noexcept;
[[nodiscard]] std::span<const Case> arm_cases() noexcept;
[[nodiscard]] std::span<const Case> robust_cases() noexcept;
[[nodiscard]] std::span<const Case> death_cases() noexcept;

}  // namespace armjig::kinovazed::conformance
