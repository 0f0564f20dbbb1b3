// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/suite.hpp"

namespace armjig::kinovazed {

[[nodiscard]] Suite suite() noexcept;

}  // namespace armjig::kinovazed
