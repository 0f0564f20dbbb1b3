// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/suite.hpp"

namespace armjig::demo {

/// What the demo device has to do; the worked example of docs/adding-a-device.md.
[[nodiscard]] Suite suite() noexcept;

}  // namespace armjig::demo
