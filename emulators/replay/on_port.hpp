// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "emulators/replay/replay.hpp"
#include "harness/link/bus_port.hpp"
#include "harness/link/session_source.hpp"
#include "harness/link/stream_port.hpp"

/// Does to a fresh device in memory what a recording says that was done to one like it: a recording
/// of `--capture`, whose device was emulated. Each answer has to have come by the time at which it
/// was recorded; that it came earlier is not seen, for the host may not have looked. What the host
/// never read is in no recording, so answers behind the last one are passed over.
///
/// Problems: `kMalformed` for what no such recording has.
namespace armjig {

[[nodiscard]] Outcome<Replayed> replay_on(StreamPort& port, const Trace& trace);
[[nodiscard]] Outcome<Replayed> replay_on(SessionSource& server, const Trace& trace);
/// Address and bytes that were refused are compared, too.
[[nodiscard]] Outcome<Replayed> replay_on(BusPort& port, const Trace& trace);

/// Whether `--capture` or `record` made the recording with that header.
[[nodiscard]] bool is_of_capture(std::string_view header);

/// What the device was, from the header of a recording: `emulated:?OPTIONS`. Problems:
/// `kUnsupported` if it was not emulated, or nobody says.
[[nodiscard]] Outcome<std::string> emulated_target_of(const Trace& trace);

}  // namespace armjig
