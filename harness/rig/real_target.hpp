// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/link/bus_port.hpp"
#include "harness/link/serial_line.hpp"
#include "harness/link/session_source.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/rig/target.hpp"

namespace armjig {

/// Opens what the target names, which is not emulated: a byte stream, a server (nothing is
/// connected yet) or a bus; `Port` is `StreamPort`, `SessionSource` or `BusPort`. `line` is for
/// serial ports and terminals. Problems name the target and say what to do; `kBadTarget` if it is
/// of another kind.
template <class Port>
[[nodiscard]] Outcome<std::unique_ptr<Port>> open_target(const Target& target,
                                                         const SerialLine& line);
template <>
Outcome<std::unique_ptr<StreamPort>> open_target(const Target& target, const SerialLine& line);
template <>
Outcome<std::unique_ptr<SessionSource>> open_target(const Target& target, const SerialLine& line);
template <>
Outcome<std::unique_ptr<BusPort>> open_target(const Target& target, const SerialLine& line);

}  // namespace armjig
