// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "emulators/host/hosted_server.hpp"
#include "harness/link/session_source.hpp"

namespace armjig {

/// Ports to a server in this process, on one virtual clock.
[[nodiscard]] std::unique_ptr<SessionSource> make_memory_server(
    std::unique_ptr<HostedServer> server);

}  // namespace armjig
