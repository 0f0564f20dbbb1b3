// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "cli/command.hpp"
#include "cli/device.hpp"
#include "emulators/shadow/shadow.hpp"

namespace armjig::cli {

/// What is to run beside the device, as written.
struct ShadowOptions {
  std::string target;  ///< empty: nothing
  std::string rules;
};

/// Adds `--shadow` and `--rules`.
void add_shadow_options(CLI::App& command, ShadowOptions& options);

/// An emulated device beside another one, and what is said of it on standard error.
class LiveShadow {
 public:
  /// nullptr if nobody asked. `beside` is the target that it is led beside. Problems: `kBadTarget`
  /// for one that is not emulated, those of making it, and of the rules.
  [[nodiscard]] static Outcome<std::unique_ptr<LiveShadow>> open(const Device& device,
                                                                 const Target& beside,
                                                                 const ShadowOptions& options);

  /// Has to overhear the device, and to outlive it.
  [[nodiscard]] Overhearer& overhearer() noexcept { return *shadow_; }

  /// Sums up on standard error.
  [[nodiscard]] Exit conclude();

 private:
  LiveShadow(AnyHosted twin, const Device& device, ComparisonRules rules);

  std::size_t told_ = 0;  ///< since they agreed last
  std::unique_ptr<Shadow> shadow_;
};

}  // namespace armjig::cli
