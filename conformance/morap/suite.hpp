// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/device.hpp"

namespace armjig::morap::conformance {

/// The MORAP motor nodes, and the programs that are their master.
[[nodiscard]] Suite suite() noexcept;

/// A conversation with a node: of an emulated bus the one that the target's options say, of another
/// bus the first that answers. Problems: `kUnknownOption`, `kBadValue`.
[[nodiscard]] Outcome<std::unique_ptr<Bench>> make_bench(Rig<BusPort> rig, const RigOptions& how);

/// Every fault that the emulated node can have, and which of them nobody can see.
[[nodiscard]] MutantsEntry mutants_entry() noexcept;

}  // namespace armjig::morap::conformance
