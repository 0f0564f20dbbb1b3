// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "harness/core/error.hpp"
#include "harness/link/session_source.hpp"
#include "harness/rig/rig.hpp"

namespace armjig {

/// Makes an emulated server from the target's options; as `OpenEmulated`.
using OpenEmulatedServer = Outcome<std::unique_ptr<SessionSource>> (*)(const Target& target);

/// A server on the jig for several clients at once: `emulated:` or `tcp:HOST:PORT`, each connection
/// judged unless it is emulated (what is not permitted fails with `kForbidden`), and logged and
/// impaired if the options say so. `device` must be one that this room knows. Problems:
/// `kBadTarget` for other targets, and that of the wire log.
[[nodiscard]] Outcome<std::unique_ptr<SessionSource>> open_server(std::string_view device,
                                                                  const RigOptions& options,
                                                                  OpenEmulatedServer open_emulated);

}  // namespace armjig
