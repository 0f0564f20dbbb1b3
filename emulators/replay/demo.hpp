// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emulators/replay/replay.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/error.hpp"

namespace armjig::demo::replay {

/// Drives a fresh demo device on a stream with the `to_device` lines of a recording.
[[nodiscard]] Outcome<Replayed> replay(const Trace& trace);

}  // namespace armjig::demo::replay
