// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "emulators/faults/faulty.hpp"
#include "emulators/parol6/defects/defects.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/target.hpp"

namespace armjig::parol6 {

/// An emulated board as its options describe it: `profile=firmware|documented`, what of that to
/// change (`crc=ignore|d4|d4-or-e4`, `estop=report|disable`, `bounds=none|stop`), `pass-us=N` (main
/// loop period in microseconds, 1 to 1000), `fault=NAME` (see `add_fault`, several with `,`).
/// `where` is for messages. Problems: `kUnknownOption`, `kBadValue`.
[[nodiscard]] Outcome<Faulty<DefectiveArm>> make_arm(const DeviceOptions& options,
                                                     const std::string& where);

}  // namespace armjig::parol6
