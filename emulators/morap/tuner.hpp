// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "emulators/morap/eeprom.hpp"
#include "emulators/morap/profile.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::morap::emulation {

/// The parameters that a node computes from a tuning message, bit for bit: single precision, one
/// rounding for each operation, in the order of docs/spec/morap.md, section Tuner. None if the
/// node refuses the request.
[[nodiscard]] std::optional<ControllerSet> tune(const TuneRequest& request,
                                                const MotorConstants& motor,
                                                const Profile& profile) noexcept;

}  // namespace armjig::morap::emulation
