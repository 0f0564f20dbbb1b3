// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "conformance/bench.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::morap {

/// A conversation with the node that a target names. Its options: `node=N` (2 if nothing is said)
/// and `motor=dcx22l|dcx26l`; of `emulated:` also `profile=firmware|documented` and `fault=NAME`
/// (see `add_fault`, several with `,`). Problems: `kBadTarget`, `kUnknownOption`, `kBadValue`.
[[nodiscard]] Outcome<std::unique_ptr<Bench>> open_node(const RigOptions& how);

}  // namespace armjig::morap
