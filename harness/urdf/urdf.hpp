// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/arm/arm.hpp"
#include "harness/core/error.hpp"

namespace armjig::arm {

/// The chain of an URDF robot from its root link to the link named `tip`; fixed joints become parts
/// of their neighbours. Without a `tip`, the robot must end in one place. `path` is for messages.
[[nodiscard]] Outcome<Arm> arm_from_urdf(const std::string& path, const std::string& xml,
                                         std::string_view tip = {});

/// The same from a file.
[[nodiscard]] Outcome<Arm> read_urdf(const std::string& path, std::string_view tip = {});

}  // namespace armjig::arm
