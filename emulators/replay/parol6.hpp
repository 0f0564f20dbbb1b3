// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emulators/parol6/defects/defects.hpp"
#include "emulators/replay/replay.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/error.hpp"

namespace armjig::parol6::replay {

/// A board on the plant and the clocks that the header of a recording names, with nothing on its
/// CAN.
[[nodiscard]] Outcome<emulation::DefectiveArm> set_up(const Trace& recording);

/// As `Replay::touches_of`, of frames that others sent on the CAN.
[[nodiscard]] DeviceTouches touches_of(std::string_view line);

/// Drives a fresh board with the stimulus of a recording, on the plant and the clocks that its
/// header names, and answers what the board sent. CAN frames are among it only if the recording has
/// them.
[[nodiscard]] Outcome<Replayed> replay(const Trace& trace);

/// The same without any leap over passes that repeat each other: slower, and the answer is the
/// same.
[[nodiscard]] Outcome<Replayed> replay_plainly(const Trace& trace);

}  // namespace armjig::parol6::replay
