// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "harness/wire/field.hpp"

namespace armjig::parol6 {

/// Every byte of a command frame and of a telemetry frame, in order, without gaps. Offsets count
/// from the first start byte.
[[nodiscard]] std::span<const Field> command_fields() noexcept;
[[nodiscard]] std::span<const Field> telemetry_fields() noexcept;

}  // namespace armjig::parol6
