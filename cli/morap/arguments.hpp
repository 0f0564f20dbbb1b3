// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "emulators/morap/eeprom.hpp"
#include "emulators/morap/profile.hpp"
#include "harness/drive/morap/joint.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::cli {

/// A tuning request as it is written on a command line.
struct TuneArguments {
  std::string type;
  double inertia = 0;
  double pole = 0;

  [[nodiscard]] morap::TuneRequest request() const;
};

/// Adds `--type`, `--inertia` and `--pole`. Their ranges are the node's to judge.
struct TuneOptions {
  CLI::Option* type;
  CLI::Option* inertia;
  CLI::Option* pole;
};
TuneOptions add_tune_options(CLI::App& app, TuneArguments& arguments);

/// Adds `--motor`: the joint whose constants the node has.
void add_motor_option(CLI::App& app, std::string& motor);

/// Requires a name that `--motor` takes.
[[nodiscard]] morap::emulation::Eeprom eeprom_of(const std::string& motor);

}  // namespace armjig::cli
