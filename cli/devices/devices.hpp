// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/device.hpp"

namespace armjig {

namespace parol6 {
[[nodiscard]] cli::Device device();
}
namespace kinovazed {
[[nodiscard]] cli::Device device();
}
namespace morap {
[[nodiscard]] cli::Device device();
}
namespace demo {
[[nodiscard]] cli::Device device();
}

namespace cli {

/// The devices of the armjig program; the first is the example in its help.
[[nodiscard]] Devices shipped_devices();

}  // namespace cli
}  // namespace armjig
