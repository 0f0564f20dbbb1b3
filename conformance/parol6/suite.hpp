// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/device.hpp"

namespace armjig::parol6::conformance {

/// The PAROL6 control board, and the programs that talk to it.
[[nodiscard]] Suite suite() noexcept;

/// A conversation with the board.
[[nodiscard]] Outcome<std::unique_ptr<Bench>> make_bench(Rig<StreamPort> rig,
                                                         const RigOptions& how);

/// Every fault that the emulated board can have, and which of them nobody can see.
[[nodiscard]] MutantsEntry mutants_entry() noexcept;

}  // namespace armjig::parol6::conformance
