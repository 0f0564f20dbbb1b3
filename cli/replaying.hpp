// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/recorded_session.hpp"
#include "harness/compare/recording_diff.hpp"
#include "harness/compare/rules.hpp"
#include "harness/foreign/foreign.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::cli {

/// How the host's side of a recording is played, and what may differ then.
struct ReplayHow {
  RigOptions rig;
  std::optional<ComparisonRules> rules;  ///< none: those of `rules_beside` the target
  double speed = 1;                      ///< 2: in half the time
  ForeignHow foreign;
};

/// How the device's side of a recording is played, and what may differ then.
struct ListenHow {
  std::string place;  ///< where the program finds it, as for `parse_listen`
  bool wants_json = false;
  ComparisonRules rules;
  double speed = 1;
  ForeignHow foreign;
};

/// What the other side of a recording says now, beside what it had said.
struct ReplayedRecording {
  RecordedMessages expected;
  RecordedMessages actual;
  std::vector<RecordingDifference> found;  ///< of the messages of both
  /// What could neither be played nor seen there, by its name, and how often.
  std::map<std::string, std::size_t> left_out;

  [[nodiscard]] std::size_t count() const { return expected.count() + actual.count(); }
};

/// Plays a recording of one link to the device behind `how.rig`. Problems: of the file, of the
/// target, `kForbidden` for what the recording needs and was not granted, before the first byte.
[[nodiscard]] Outcome<ReplayedRecording> replay_recording(Devices devices, const std::string& path,
                                                          const ReplayHow& how);

enum class Compare : std::uint8_t { kNo, kYes };

/// The same of one that was read already. `path` is that of the recording. `Compare::kNo`: what
/// differs is not looked for.
[[nodiscard]] Outcome<ReplayedRecording> replay_session(Devices devices, const KnownSession& known,
                                                        const std::string& path,
                                                        const ReplayHow& how, Compare compare);

/// Plays the device until the recording is over or a signal comes. Problems: of the file and the
/// place.
[[nodiscard]] Outcome<ReplayedRecording> play_recorded_device(Devices devices,
                                                              const std::string& path,
                                                              const ListenHow& how);

}  // namespace armjig::cli
