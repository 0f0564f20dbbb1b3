// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "conformance/bench.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::morap {

/// A conversation with a node. Options of `emulated:` are `node=N` (2 if nothing is said),
/// `motor=dcx22l|dcx26l`, `profile=firmware|documented` and `fault=NAME` (see `add_fault`, several
/// with `,`); of another bus it is the first node that answers. Problems: those of `BusRig::open`,
/// `kUnknownOption`, `kBadValue`.
[[nodiscard]] Outcome<std::unique_ptr<Bench>> open_node(const RigOptions& how);

}  // namespace armjig::morap
