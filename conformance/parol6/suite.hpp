// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/suite.hpp"

namespace armjig::parol6 {

/// Framing and telemetry of the PAROL6 board, profile `firmware`. Nothing here moves a joint.
[[nodiscard]] Suite suite() noexcept;

}  // namespace armjig::parol6
