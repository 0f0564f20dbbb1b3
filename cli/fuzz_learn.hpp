// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "conformance/bench.hpp"
#include "harness/report/report.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::cli {

/// What `armjig fuzz --learn` is told besides.
struct LearnSettings {
  bool is_wanted = false;
  std::string machine;             ///< of those that the entry has; empty: all
  std::uint64_t letters = 10'000;  ///< most, all words of all machines together
  std::optional<double> quiet{};   ///< seconds
  double speed = 1;                ///< of a device that is not emulated
  std::string drawing;             ///< a file
};

/// Adds `--learn`, which takes none of the options `except`, and those that go with it.
void add_learn_options(CLI::App& command, LearnSettings& settings,
                       const std::vector<CLI::Option*>& except);

/// All that a run of it needs.
struct LearnRun {
  const Device& device;
  const RigOptions& how;
  const Hand& hand;
  const LearnSettings& settings;
  std::uint64_t seed = 1;
  const ReportFiles& files;
  const std::string& colour;
  std::string repeat;  ///< the command that does it again
};

/// Learns the machines that the device shows and says where they are not as documented.
[[nodiscard]] Exit learn(const LearnRun& run);

}  // namespace armjig::cli
