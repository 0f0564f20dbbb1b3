// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/device.hpp"
#include "emulators/replay/what_if.hpp"

namespace armjig::cli {

/// Judges by what is demanded of programs for the device; nullptr if nothing is.
[[nodiscard]] std::unique_ptr<TrialJudge> make_trial_judge(const Device& device,
                                                           const LinkNoise& noise);

/// A program, started again for each trial, that talks to a copy of an emulated device on a link of
/// its own.
struct ProgramTrial {
  const Device& device;
  const AnyHosted& emulated;         ///< as it is when the program starts
  Instant begin{};                   ///< the device's time then
  std::vector<std::string> command;  ///< `{}` and `{port}` in it stand for the place
  Duration patience{};               ///< after that it is killed
  double speed = 1;                  ///< device time over wall time
  /// How it ended without a perturbation: its exit code.
  std::optional<int> usual_end{};

  /// A trial without perturbations comes first. Problems: those of the link and of starting it,
  /// `kTimedOut` if it does not end even then.
  [[nodiscard]] Outcome<TrialResult> operator()(const std::vector<Perturbation>& wanted);
};

}  // namespace armjig::cli
