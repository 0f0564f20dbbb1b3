// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "emulators/shadow/fit.hpp"

namespace armjig::parol6::shadow {

/// What differs from one of them to the next, in the order in which it is told.
[[nodiscard]] std::span<const FitFigure> figures() noexcept;

}  // namespace armjig::parol6::shadow
