// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "harness/wire/field.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6 {

/// Every byte of a command frame and of a telemetry frame, in order, without gaps. Offsets count
/// from the first start byte.
[[nodiscard]] std::span<const Field> command_fields() noexcept;
[[nodiscard]] std::span<const Field> telemetry_fields() noexcept;

/// `idle`, or `200` for a code without a name.
[[nodiscard]] std::string name_of(Command command);

}  // namespace armjig::parol6
