// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "emulators/replay/kept_record.hpp"

namespace armjig {

/// What was done beside the link, as `set_input` of an emulated device takes it.
struct DeviceTouch {
  std::string name;
  std::int64_t value{};
};
using DeviceTouches = std::vector<DeviceTouch>;

/// What a line of a device's recordings did beside the link (one JSON object); nothing: nothing
/// that an input can do. nullptr: only lines like `"dir":"input","name":"estop","value":0` do.
using TouchesOf = DeviceTouches (*)(std::string_view line);

/// The same of a record: an event, or a CAN frame to the device, whose line is as in
/// `golden-trace/1`. Nothing for what passed on the link itself.
[[nodiscard]] DeviceTouches touches_of(const KeptRecord& record, TouchesOf of_device);

}  // namespace armjig
