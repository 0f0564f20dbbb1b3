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
inline void require_well_formed(const std::vector<TraceEvent>& answers, Dissector& dissector) {
  std::vector<Message> messages;
  for (const auto& event : answers) {
    if (event.dir != "from_device") continue;
    dissector.feed(Direction::kFromDevice, event.time, event.bytes, messages);
  }
  for (const auto& message : messages) {
    if (!message.fault.empty()) std::cerr << to_text(message) << '\n';
    require(message.fault.empty(), "every answer is a message");
  }
}

/// Sessions that end by then are compared with the plain model, which takes its time.
inline constexpr Instant kShort = at(std::chrono::milliseconds{100});

/// Plays the session that the bytes say, of at most `longest`: the whole emulator, at its times,
/// with inputs, resets, connections or operations on the bus. It answers in whole messages, and as
/// its plain model does if it is short; else, or where there is none, the same the second time.
inline void check_session(const test::DrawnDevice& device, std::span<const std::uint8_t> input,
                          Duration longest) {
  const auto session = parse_trace("session", device.draw(Roll{std::as_bytes(input), longest}));
  require(session.has_value(), "what is drawn is a session");
  const auto& recorded = *test::recorded_device(*session);
  const auto& replay = recorded.replay;
  const auto fast = replay.run(*session);
  const bool is_short = session->events.empty() || session->events.back().time <= kShort;
  const auto run_again =
      is_short && replay.run_plainly != nullptr ? replay.run_plainly : replay.run;
  const auto other = run_again(*session);
  require(fast && other, "a session can be played");
  require_well_formed(fast->actual, *recorded.make_dissector());
  const auto difference = first_difference(other->actual, fast->actual);
  if (difference) std::cerr << describe(*difference, *session, recorded.make_dissector) << '\n';
  require(!difference, "the emulator does what its plain model does, and the same again");
}

}  // namespace armjig::fuzz
