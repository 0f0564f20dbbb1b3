// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emulators/replay/replay.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/error.hpp"

namespace armjig::morap::replay {

/// Puts the nodes and pens that the header names on a fresh bus, drives it with the operations of
/// the recording, and answers acknowledgements, bytes read and states of the pen. Bytes that the
/// recording masks are 0 on both sides.
[[nodiscard]] Outcome<Replayed> replay(const Trace& trace);

}  // namespace armjig::morap::replay
