// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "emulators/kinovazed/defects/defective_server.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/target.hpp"

namespace armjig::kinovazed {

/// A server as its options describe it: `profile=firmware|documented`, `plant=jaco|bench`,
/// `objectives=FILE`, `on-death=stay|restart`, `race=reply|event|random`, `call-us=N` (length of a
/// call to the arm, 0 to 100000), and `fault=`, by `add_fault`. `where` is for messages. Problems:
/// `kUnknownOption`, `kBadValue`, and `kMalformed` for the file.
[[nodiscard]] Outcome<DefectiveServer> make_server(const DeviceOptions& options,
                                                   const std::string& where);

}  // namespace armjig::kinovazed
