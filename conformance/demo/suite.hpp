// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/device.hpp"

namespace armjig::demo::conformance {

/// What the demo device has to do; the worked example of docs/adding-a-device.md.
[[nodiscard]] Suite suite() noexcept;

/// A conversation with the device.
[[nodiscard]] Outcome<std::unique_ptr<Bench>> make_bench(Rig<StreamPort> rig,
                                                         const RigOptions& how);

/// Faults of each field of a reply.
[[nodiscard]] MutantsEntry mutants_entry() noexcept;

}  // namespace armjig::demo::conformance
