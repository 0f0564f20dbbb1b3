// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/link/bus_port.hpp"
#include "harness/link/session_source.hpp"
#include "harness/link/stream_port.hpp"

/// Emulated devices as a link shows them: nothing can be seen or done but there. Time stays
/// virtual.
namespace armjig::test {

[[nodiscard]] std::unique_ptr<StreamPort> without_hands(std::unique_ptr<StreamPort> port);
[[nodiscard]] std::unique_ptr<SessionSource> without_hands(std::unique_ptr<SessionSource> port);
/// It has whole messages only, as the bus of an operating system.
[[nodiscard]] std::unique_ptr<BusPort> without_hands(std::unique_ptr<BusPort> port);

}  // namespace armjig::test
