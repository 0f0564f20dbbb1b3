// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "emulators/kinovazed/pose.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/kinovazed/vocabulary.hpp"

namespace armjig::kinovazed::emulation {

/// How long the server pauses and waits (docs/spec/kinovazed.md, "Times").
namespace pace {
using std::chrono::milliseconds;
inline constexpr Duration kPoll = milliseconds{10};
inline constexpr Duration kPause = milliseconds{10};  ///< behind press, release, axes, erase
inline constexpr Duration kLongPress = milliseconds{200};
inline constexpr Duration kOpen = milliseconds{50};
inline constexpr Duration kReopen = milliseconds{50};
inline constexpr Duration kRetryAtStart = milliseconds{1000};
inline constexpr Duration kModeSettles = milliseconds{500};
inline constexpr Duration kBeat = milliseconds{1000};
inline constexpr Duration kRestart = milliseconds{2000};
}  // namespace pace

/// All in which a documented server and the shipped one differ, line reading aside
/// (`LineReceiver`, `decode_command`). docs/spec/kinovazed.md has the reasons.
struct Behaviour {
  Profile profile{};
  /// kinovazed.line.silence: what is no command gets no answer, not `Rejected`.
  bool ignores_bad_lines{};
  /// kinovazed.reply.accepted-first: `Accepted` also for commands that have an event of their own.
  bool accepts_before_event{};
  /// kinovazed.reply.recurring: a command whose result still holds gets its event again.
  bool repeats_events{};
  /// kinovazed.beat.lost-arm: a beat waits for the supervision of the arm instead of showing bit 0.
  bool beat_asks_supervision{};
  /// kinovazed.objective.current: `Current` is a motion like all others.
  bool moves_for_current{};
  /// kinovazed.objective.still-arm: only a changed reading can reach a way-point.
  bool needs_change_to_reach{};
  /// kinovazed.objective.hijack: SetActiveObjective and refused RunObjectives replace the objective
  /// that runs.
  bool shares_objective{};
  /// kinovazed.retract.while-initializing: an arm that ends folded leaves the server stuck.
  bool sticks_when_folded{};
  /// "Deaths": some failures hang, end or mute the server.
  bool dies{};
  std::size_t objective_count{};  ///< the first so many of `Objective` are known

  // Figures in which the two agree.
  Duration beat_period = pace::kBeat;
  Duration mode_settles = pace::kModeSettles;
  float units_per_full = 0.0025F;  ///< kinovazed.joystick.scale
  Reach reach{};
  /// Off in both, since the shipped server does it only now and then: the third client that resets
  /// before it has heard anything, with nobody served before it, ends the process.
  bool dies_of_resets = false;
};

inline constexpr Behaviour kFirmwareBehaviour{
    Profile::kFirmware, true, true, false, true, true, true, true, true, true, 9};
inline constexpr Behaviour kDocumentedBehaviour{
    Profile::kDocumented, false, false, true, false, false, false, false, false, false,
    kDocumentedObjectives};

/// Who comes first when an action is over the moment it is asked for: both happen on real servers
/// (kinovazed.reply.race).
enum class RaceOrder : std::uint8_t { kReplyFirst, kEventFirst, kRandom };

}  // namespace armjig::kinovazed::emulation
