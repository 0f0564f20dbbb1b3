// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/device.hpp"

namespace armjig::kinovazed::conformance {

/// The KinovaZED server, and the programs that are its clients.
[[nodiscard]] Suite suite() noexcept;

/// A conversation with the server, whose first client is connected. Problems: that it cannot be.
[[nodiscard]] Outcome<std::unique_ptr<Bench>> make_bench(Rig<SessionSource> rig,
                                                         const RigOptions& how);

/// Every fault that the emulated server can have, and which of them nobody can see.
[[nodiscard]] MutantsEntry mutants_entry() noexcept;

}  // namespace armjig::kinovazed::conformance
