// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emulators/lab/client_memory.hpp"
#include "emulators/lab/i2c_adapter.hpp"

namespace armjig::lab {

/// Answers what programs ask of a device node of an I2C bus: ioctls, reads and writes. `adapter`
/// must outlive it.
[[nodiscard]] GObjectRef<UMockdevIoctlBase> answer_i2c_calls(I2cAdapter& adapter);

}  // namespace armjig::lab
