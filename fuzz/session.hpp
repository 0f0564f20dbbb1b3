// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "fuzz/require.hpp"
#include "harness/wire/dissector.hpp"
#include "tests/unit/emulators/sessions/drawn_session.hpp"

namespace armjig::fuzz {

/// What the emulator says is made of whole messages. On a bus any bytes are an answer.
inline void require_well_formed(const Trace& trace) {
  std::vector<Message> messages;
  const auto dissector = test::recorded_device(trace)->make_dissector();
  for (const auto& event : trace.events) {
    if (event.dir != "from_device") continue;
    dissector->feed(Direction::kFromDevice, event.time, event.bytes, messages);
  }
  for (const auto& message : messages) {
    if (!message.fault.empty()) std::cerr << to_text(message) << '\n';
    require(message.fault.empty(), "every answer is a message");
  }
}

/// Plays the session that the bytes say, of at most `longest`: the whole emulator, at its times,
/// with inputs, resets, connections or operations on the bus. It answers the same the second time,
/// as its plain model does, and in whole messages.
inline void check_session(const test::DrawnDevice& device, std::span<const std::uint8_t> input,
                          Duration longest) {
  const Roll roll{std::as_bytes(input), longest};
  const auto recording = test::recording_of(device, roll);
  require(recording.has_value(), "a session is a recording");
  const auto trace = parse_trace("session", *recording);
  require(trace.has_value(), "a recording can be read");
  require_well_formed(*trace);
  const auto complaint = test::complaint_about_recording(device, roll) +
                         test::complaint_about_plain_model(device, roll);
  if (!complaint.empty()) std::cerr << complaint << '\n';
  require(complaint.empty(), "the emulator does the same again, and what its plain model does");
}

}  // namespace armjig::fuzz
