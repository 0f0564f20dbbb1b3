// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/rig/judge.hpp"

namespace armjig::demo::rig {

/// Starting is motion; everything else is harmless.
[[nodiscard]] std::unique_ptr<Judge> make_judge();

}  // namespace armjig::demo::rig
