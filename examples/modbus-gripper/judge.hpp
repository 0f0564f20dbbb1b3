// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/rig/judge.hpp"

namespace gripper {

/// For the guard of a real gripper. Reading is harmless, and so is to stop; settings are `state`,
/// moves are `grip`.
[[nodiscard]] std::unique_ptr<armjig::Judge> make_judge();

}  // namespace gripper
