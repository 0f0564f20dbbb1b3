// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "emulators/sessions/dice.hpp"
#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"

/// The session of a seed, for each device: a recording (`golden-trace/1`) of all that is done to it
/// and nothing that it does. The same text with every compiler.
namespace armjig {

/// What a session is drawn by. A seed does all by itself; a fuzzer says what falls, and how long a
/// session may be, in the time of the device.
struct Roll {
  sessions::Dice dice;
  std::uint64_t seed{};
  Duration longest = Duration::max();

  Roll(std::uint64_t from) : dice{from}, seed{from} {}  // NOLINT(*-explicit-*): a seed is one
  Roll(Bytes choices, Duration at_most) : dice{choices}, longest{at_most} {}
};

using DrawSession = std::string (*)(const Roll& roll);

namespace parol6::sessions {
[[nodiscard]] std::string draw(const Roll& roll);
}
namespace morap::sessions {
[[nodiscard]] std::string draw(const Roll& roll);
}
namespace kinovazed::sessions {
[[nodiscard]] std::string draw(const Roll& roll);
}

}  // namespace armjig
