// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "emulators/campaign/alphabet.hpp"

namespace gripper {

/// What `fuzz --learn` asks the gripper, and the machine that it should be.
[[nodiscard]] std::span<const armjig::campaign::Learnable> machines();

}  // namespace gripper
