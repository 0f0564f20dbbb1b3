// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "conformance/suite.hpp"

namespace armjig {

/// The chapter that every suite may have: in sessions drawn at random the device does what the
/// reference does. `id` and `source` are of its requirement.
[[nodiscard]] Chapter sessions_chapter(std::string_view id, std::string_view source);

}  // namespace armjig
