// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/target_options.hpp"
#include "harness/latency/latency_run.hpp"
#include "harness/latency/load.hpp"

/// What `armjig latency` can be asked for.
namespace armjig::cli {

/// As written.
struct LatencyOptions {
  std::string device;
  TargetOptions target;
  std::string against;
  std::string exchange;
  std::string sweep;
  std::string from;
  std::string baseline;
  double rate = 100;
  bool is_closed_loop = false;
  std::size_t burst = 1;
  std::optional<std::uint64_t> count;
  std::optional<double> seconds;
  double timeout = 1;
  std::string load;
  std::string limits;
  int priority = 50;
  std::optional<int> processor;
  std::string json;
  std::string html;
  std::string histogram_log;
  bool has_cost = false;
  std::optional<double> cost_limit;
  std::uint64_t seed = 1;
  std::uint64_t sending = 0;
};

/// What was asked for, read.
struct Wanted {
  MeterPlan plan;
  Meter::Until until;
  std::optional<LoadPlan> load;
  std::vector<Limit> limits;
  std::optional<Baseline> baseline;
};

/// Problems: of limits, load, and the file of `--compare`.
[[nodiscard]] Outcome<Wanted> wanted_of(const LatencyOptions& options);

/// What is told of one run: `rate=50`, and the options with that.
struct Point {
  std::string name;
  LatencyOptions options;
};

/// One for each value of `--sweep`; without it the only one. Problems: `kBadValue`.
[[nodiscard]] Outcome<std::vector<Point>> points_of(const LatencyOptions& options);

/// One target, or with `--against` two. Problems: those of targets, and `kBadValue` for what they
/// cannot be asked for.
[[nodiscard]] Outcome<std::vector<RigOptions>> targets_of(const LatencyOptions& options);

void add_latency_options(CLI::App& command, LatencyOptions& options, Devices devices);

}  // namespace armjig::cli
