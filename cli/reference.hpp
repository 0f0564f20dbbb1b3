// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "cli/device.hpp"
#include "conformance/bench.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::cli {

/// Opens, as often as it is called, an emulated device that obeys on a link of the same kind as
/// that of a target, with the same impairments: what the link adds shows there. Where time is real
/// a thread of its own serves the device as long as the bench lives. The bench is none if such a
/// link cannot be had here, as of a bus. `device` outlives all.
[[nodiscard]] std::function<std::shared_ptr<Bench>()> reference_of(const Device& device,
                                                                   const RigOptions& how,
                                                                   const std::string& profile);

}  // namespace armjig::cli
