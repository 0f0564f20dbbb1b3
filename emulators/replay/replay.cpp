// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/replay.hpp"

#include <algorithm>
#include <array>

#include "emulators/replay/demo.hpp"
#include "emulators/replay/kinovazed.hpp"
#include "emulators/replay/kinovazed_rules.hpp"
#include "emulators/replay/morap.hpp"
#include "emulators/replay/parol6.hpp"

namespace armjig {
namespace {

constexpr std::array kReplays{
    ReplayEntry{"demo", demo::replay},
    ReplayEntry{"kinovazed", kinovazed::replay, kinovazed::session_difference},
    ReplayEntry{"morap", morap::replay},
    ReplayEntry{"parol6", parol6::replay},
};

/// `morap-node` and `morap-bus` are recordings of morap.
std::string_view family_of(std::string_view device) { return device.substr(0, device.find('-')); }

}  // namespace

std::span<const ReplayEntry> replays() noexcept { return kReplays; }

Outcome<std::optional<TraceDifference>> verify(const Trace& trace) {
  const auto entry = std::ranges::find(kReplays, family_of(trace.device), &ReplayEntry::device);
  if (entry == kReplays.end()) {
    return problem(ErrorCode::kUnknownDevice, trace.path,
                   "no emulator replays '" + trace.device + "' yet");
  }
  const auto replayed = entry->replay(trace);
  if (!replayed) return tl::unexpected{replayed.error()};
  return entry->compare(replayed->recorded, replayed->actual);
}

}  // namespace armjig
