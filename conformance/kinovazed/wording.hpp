// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include "conformance/kinovazed/server_bench.hpp"

namespace armjig::kinovazed::conformance {

/// Expects a time to be within bounds. What the link itself may add is up to the caller.
inline void expect_time(ServerBench& server, Duration time, Duration least, Duration most) {
  server.expect_in_time({milliseconds(time), milliseconds(least), milliseconds(most), "ms"},
                        fmt::format("{:.0f} to {:.0f} ms", milliseconds(least), milliseconds(most)),
                        fmt::format("{:.1f} ms", milliseconds(time)));
}

}  // namespace armjig::kinovazed::conformance
