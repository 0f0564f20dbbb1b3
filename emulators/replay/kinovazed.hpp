// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "emulators/kinovazed/defects/defective_server.hpp"
#include "emulators/replay/replay.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/error.hpp"

namespace armjig::kinovazed::replay {

/// A server with the arm that the header of a recording describes, which began to listen when that
/// one did.
[[nodiscard]] Outcome<emulation::DefectiveServer> set_up(const Trace& recording);

/// As `Replay::touches_of`, of the arm. Failures that come only after some calls are none.
[[nodiscard]] DeviceTouches touches_of(std::string_view event);

/// Drives a fresh server, with the arm that the header describes behind it, by what clients and arm
/// did in a recording, as captures/kinovazed/README.md says: each line when all that was recorded
/// before it has come, not before its time, and not sooner after the line before it.
///
/// The events of both lists are `from_device`, `disconnect` and `connect` of a connection (`id`),
/// and `end`, what is left of the server (`name`). `value` is the time in microseconds since the
/// last thing that a client or the arm did.
[[nodiscard]] Outcome<Replayed> replay(const Trace& trace);

/// What came over a connection, the line with what became of a client's call, or the header with
/// what is left of the server.
[[nodiscard]] std::string write(std::string_view line, const TraceEvent& actual);

}  // namespace armjig::kinovazed::replay
