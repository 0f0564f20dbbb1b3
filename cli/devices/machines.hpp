// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "emulators/campaign/alphabet.hpp"

/// The machines that our devices show, as their documents have them.
namespace armjig {

namespace parol6 {
[[nodiscard]] std::span<const campaign::Learnable> machines();
}
namespace kinovazed {
[[nodiscard]] std::span<const campaign::Learnable> machines();
}
namespace morap {
[[nodiscard]] std::span<const campaign::Learnable> machines();
}

}  // namespace armjig
