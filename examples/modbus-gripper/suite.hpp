// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "conformance/device.hpp"
#include "harness/rig/rig.hpp"

namespace gripper {

/// What a unit on a Modbus line, and this gripper, has to do.
[[nodiscard]] armjig::Suite suite() noexcept;
[[nodiscard]] std::unique_ptr<armjig::Bench> make_bench(armjig::Rig<armjig::StreamPort> rig,
                                                        unsigned baud, bool is_emulated);

/// Each defect, and three faults of each field of a reply.
[[nodiscard]] armjig::MutantsEntry mutants() noexcept;

}  // namespace gripper
