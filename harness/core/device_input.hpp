// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace armjig {

/// Something that a person beside an emulated device can do, as the device's
/// `set_input(time, name, value)` takes it, and what the values are.
struct DeviceInput {
  std::string_view name;
  std::string_view values;
};

}  // namespace armjig
