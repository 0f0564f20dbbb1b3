// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/replay/kept_record.hpp"
#include "emulators/replay/touches.hpp"
#include "harness/link/bus_port.hpp"
#include "harness/link/session_source.hpp"
#include "harness/link/stream_port.hpp"

/// The host's side of a recording, played against a device, whoever and wherever it is: what the
/// host sent leaves at its time, and what the device says is kept beside what it said.
namespace armjig {

/// What becomes of the records after one that left late.
enum class AfterLate {
  kAsRecorded,  ///< each leaves at its time: what is late delays nothing that follows
  kShifted,     ///< all leave as much later, so that none come closer together
};

struct PlayHow {
  double speed = 1;        ///< 2: in half the time; what is kept has the times of the recording
  TouchesOf touches_of{};  ///< what was done beside the link
  /// On a stream, what the host sent leaves so much earlier: what was recorded of one that works in
  /// passes was there when the device looked at that moment, and what `--capture` wrote came just
  /// after it.
  Duration lead{};
  Duration trailing{};  ///< listens so much longer than the recording lasts
  /// Does beside the link what the port cannot; false: nobody can. Empty: nobody does. The clock of
  /// the recording stands still as long as it takes.
  std::function<bool(std::string_view input, std::int64_t value)> by_hand{};
  AfterLate after_late = AfterLate::kAsRecorded;
};

/// What is to be compared, of both sides in order of time.
struct Played {
  std::vector<KeptRecord> expected;
  std::vector<KeptRecord> actual;
  /// When the host ended a connection, by its number: what is later than recorded is not heard
  /// then.
  std::vector<std::pair<std::uint32_t, Instant>> ends;
  std::size_t sent{};             ///< records of the host that were played
  std::vector<Instant> passed{};  ///< when each record was dealt with, in the recording's time
  /// What no host can play on this link or nobody can see there, by its name, and how often.
  std::map<std::string, std::size_t> left_out;
};

/// Plays records of one link, and the events and CAN frames beside it. The schedule is absolute,
/// unless `PlayHow::after_late` says otherwise. Problems: those of the port, `kForbidden` among
/// them if the guard refused something; what follows is not sent then.
[[nodiscard]] Outcome<Played> play_host(StreamPort& port, std::span<const KeptRecord> records,
                                        const PlayHow& how);
/// A connection that the recording has from its middle on is begun at its first record.
[[nodiscard]] Outcome<Played> play_host(SessionSource& server, std::span<const KeptRecord> records,
                                        const PlayHow& how);
/// By single operations where the bus can, otherwise by whole transactions. What was acknowledged
/// is compared where the recording says it; behind whole transactions, as far as they tell.
[[nodiscard]] Outcome<Played> play_host(BusPort& port, std::span<const KeptRecord> records,
                                        const PlayHow& how);

}  // namespace armjig
