// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "harness/rig/guard.hpp"
#include "harness/rig/rig.hpp"

namespace armjig {

/// The file of a guarded port, for who measures times and may have nothing between. Every message
/// is announced to the guard before it is written, and what was read told afterwards. Valid as long
/// as the port.
struct DirectLine {
  int descriptor{};
  Guard* guard{};
};

/// None where something is between that has to see the bytes, or no file: a recording, impairments,
/// a bus, a device in memory, a port over Telnet. `port` was opened with `options`.
[[nodiscard]] std::optional<DirectLine> direct_line(StreamPort& port, const RigOptions& options);

}  // namespace armjig
