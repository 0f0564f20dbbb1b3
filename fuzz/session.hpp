// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <malloc.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "emulators/replay/watched.hpp"
#include "fuzz/answers.hpp"
#include "fuzz/require.hpp"
#include "tests/unit/emulators/sessions/drawn_session.hpp"

// NOLINTNEXTLINE(bugprone-reserved-identifier): the name that sanitizers give it
extern "C" std::size_t __sanitizer_get_current_allocated_bytes() __attribute__((weak));

namespace armjig::fuzz {

/// How many bytes have been allocated and not been freed.
inline std::size_t allocated() {
  return __sanitizer_get_current_allocated_bytes != nullptr
             ? __sanitizer_get_current_allocated_bytes()
             : mallinfo2().uordblks;
}

/// Sessions that end by then are compared with the plain model, which takes its time.
inline constexpr Instant kShort = at(std::chrono::milliseconds{100});

/// Watches a device as `Promises` say, and lets copies of it go on now and then: after 1, 2, 4, 8
/// lines and so on. What a copy takes of the heap does not grow with what was played.
template <class Promises>
Onlooker<typename Promises::Device> watch_with(Promises& promises) {
  return [&promises, lines = std::uint64_t{}](auto& device, Instant time) mutable {
    promises.see(device, time);
    if (!std::has_single_bit(++lines)) return;
    using Device = typename Promises::Device;
    auto copy = std::make_unique<Device>(device);
    device = *copy;
    Promises::take_what_it_said(*copy);
    const auto before = allocated();
    const auto measured = *copy;
    asm volatile("" : : "g"(&measured) : "memory");  // or compilers leave the copy out
    require(allocated() - before <= Promises::kMostHeap, "a device does not grow");
  };
}

/// Plays the session that the bytes say, of at most `longest`: the whole emulator, at its times,
/// with inputs, resets, connections or operations on the bus. It answers in whole messages, and as
/// its plain model does if it is short; else, or where there is none, the same the second time,
/// when copies of it go on, and what `Promises` see of it is possible:
/// `Promises{session}`, for each session
/// `Device`, `replay_watched`: how it is played
/// `see(device, time)`: its state and where it is, after each line of the session
/// `hear(answers)`: all of them
/// `take_what_it_said(device)`: as a host does, so that it may forget that
/// `kMostHeap`: bytes of a copy that has nothing to say, with what it has not read yet
template <class Promises>
void check_session(const test::DrawnDevice& device, std::span<const std::uint8_t> input,
                   Duration longest) {
  const auto session = parse_trace("session", device.draw(Roll{std::as_bytes(input), longest}));
  require(session.has_value(), "what is drawn is a session");
  const auto& recorded = *test::recorded_device(*session);
  const auto& replay = recorded.replay;
  const auto fast = replay.run(*session);
  const bool is_short = session->events.empty() || session->events.back().time <= kShort;
  Promises promises{*session};
  const auto other = is_short && replay.run_plainly != nullptr
                         ? replay.run_plainly(*session)
                         : Promises::replay_watched(*session, watch_with(promises));
  require(fast && other, "a session can be played");
  Answers answers{recorded.make_dissector};
  for (const auto& event : fast->actual) {
    if (event.dir == "from_device") answers.hear(event.time, event.id, event.bytes);
  }
  promises.hear(fast->actual);
  const auto difference = first_difference(other->actual, fast->actual);
  if (difference) std::cerr << describe(*difference, *session, recorded.make_dissector) << '\n';
  require(!difference,
          "the emulator does what its plain model does, and the same again, also as a copy");
}

}  // namespace armjig::fuzz
