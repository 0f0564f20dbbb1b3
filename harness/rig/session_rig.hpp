// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/link/session_source.hpp"
#include "harness/rig/rig.hpp"

namespace armjig {

/// Makes an emulated server from the target's options; as `OpenEmulated`.
using OpenEmulatedServer = Outcome<std::unique_ptr<SessionSource>> (*)(const Target& target);

/// A server on the jig: `emulated:` or `tcp:HOST:PORT`, impaired if the options say so. Nothing
/// stands between its users and a real server: they have to ask for permission by themselves.
/// Problems: `kBadTarget` for other targets, `kUnsupported` for a wire log.
[[nodiscard]] Outcome<std::unique_ptr<SessionSource>> open_server(const RigOptions& options,
                                                                  OpenEmulatedServer open_emulated);

}  // namespace armjig
