// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/rig/guard.hpp"

namespace armjig::demo {

/// Starting is motion; everything else is harmless.
[[nodiscard]] std::unique_ptr<Judge> make_judge();

}  // namespace armjig::demo
