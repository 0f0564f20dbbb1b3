// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.hpp"
#include "cli/device.hpp"
#include "cli/outputs.hpp"
#include "harness/compare/recording_diff.hpp"
#include "harness/compare/rules.hpp"

namespace armjig::cli {

/// Adds `diff`.
void add_diff(CLI::App& app, Devices devices, Action& action);

/// How two recordings are compared, and where that is told.
struct ComparisonOptions {
  std::string rules;
  std::string html;
  bool wants_json = false;
};

/// Adds `--rules`, `--json`, `--html`.
void add_comparison_options(CLI::App& app, ComparisonOptions& options);

/// What was compared: how the columns of the page are called, and how many messages there were.
struct Compared {
  std::string before;
  std::string after;
  std::size_t messages{};
  Devices devices;  ///< whose requirements speak of what differs
};

/// The first of them with fields, summaries by field and by requirement, and a verdict: several
/// lines.
[[nodiscard]] std::string describe(const std::vector<RecordingDifference>& found, Devices devices);

/// On standard output what `describe` says, or one JSON object; on the page, if there is one, both
/// side by side. Answers the exit code.
[[nodiscard]] Exit tell(const std::vector<RecordingDifference>& found, const Compared& compared,
                        bool wants_json, const Output& html);

/// Of all devices there are, for `RecordedMessages`.
[[nodiscard]] std::function<MakeDissector(std::string_view)> dissectors_of(Devices devices);

/// What the file says; none without one. Problems: those of `ComparisonRules::read`.
[[nodiscard]] Outcome<std::optional<ComparisonRules>> rules_asked_for(const std::string& path);

/// The same; without a file nothing may differ.
[[nodiscard]] Outcome<ComparisonRules> rules_of(const std::string& path);

/// What may differ between a target and an emulated device that is led beside it: what the file
/// says; without one nothing if the target is emulated, else what the entry says of live devices.
/// Problems: as above.
[[nodiscard]] Outcome<ComparisonRules> rules_beside(const Device& device, const Target& target,
                                                    const std::string& path);

}  // namespace armjig::cli
