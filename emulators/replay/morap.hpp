// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "emulators/i2c/bus.hpp"
#include "emulators/replay/replay.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/error.hpp"

namespace armjig::morap::replay {

/// The nodes and pens that the header of a recording names, on a fresh bus.
[[nodiscard]] Outcome<i2c::Bus> set_up(const Trace& recording);

/// As `Replay::touches_of`, of shafts, power and buttons.
[[nodiscard]] DeviceTouches touches_of(std::string_view line);

/// Puts the nodes and pens that the header names on a fresh bus, drives it with the operations of
/// the recording, and answers acknowledgements, bytes read and states of the pen. Bytes that the
/// recording masks are 0 on both sides.
[[nodiscard]] Outcome<Replayed> replay(const Trace& trace);

/// The same without any leap over ticks that repeat each other: slower, and the answer is the same.
[[nodiscard]] Outcome<Replayed> replay_plainly(const Trace& trace);

/// The line with acknowledgements, bytes and states in place.
[[nodiscard]] std::string write(std::string_view line, const TraceEvent& actual);

}  // namespace armjig::morap::replay
