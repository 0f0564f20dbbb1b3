// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "emulators/kinovazed/machine.hpp"
#include "harness/core/time.hpp"

namespace armjig::kinovazed::emulation {

/// What a quirk remembers, each its own.
struct QuirkMemory {
  std::string text;
  std::int64_t number = 0;
  Instant time{};
};

/// A message on its way out.
struct Saying {
  std::string text;  ///< with CR LF; empty: it does not leave; may be several
  Instant time{};
  Duration delay{};
};

/// A wrong behaviour at the sockets of a server.
struct Quirk {
  std::string name;
  std::string section;  ///< where docs/spec would have it
  /// A segment comes in.
  std::function<void(std::string& segment, QuirkMemory& memory, State state)> hear{};
  std::function<void(Saying& saying, QuirkMemory& memory, State state)> say{};
  /// A client connects and is greeted; `clients` that are connected then.
  std::function<void(std::string& greeting, QuirkMemory& memory, std::size_t clients)> come{};
  /// A client leaves, and the server hears something of it.
  std::function<void(std::string& last_words, QuirkMemory& memory)> leave{};
};

/// Those that were written by hand.
[[nodiscard]] std::span<const Quirk> quirks();

/// Those in corners that no suite looks into; `rare:NAME`. They are not among `all_faults`, for
/// they try campaigns, not suites.
[[nodiscard]] std::span<const Quirk> rare_quirks();

}  // namespace armjig::kinovazed::emulation
