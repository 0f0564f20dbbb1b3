// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "harness/core/error.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
}

namespace armjig::cli {

struct Device;
using Devices = std::span<const Device>;

/// The exit codes of every subcommand (docs/cli.md).
enum class Exit : int {
  kPassed = 0,    ///< at least one thing ran, all passed or deviated as known
  kFindings = 1,  ///< something failed or differs
  kUsage = 2,     ///< wrong arguments or unreadable input
  kRig = 3,       ///< the target is absent, busy, forbidden or silent; results cannot be written
  kNothing = 4,   ///< nothing was selected or nothing ran
  kBug = 70,      ///< ours
  kInterrupted = 130,  ///< by Ctrl-C; by another signal, 128 and its number
  kReaderGone = 141,   ///< of standard output
};

/// What a subcommand does once its arguments are parsed.
using Action = std::function<Exit()>;

/// Adds a subcommand about any of `devices` to `app`. When it is the one chosen, `action` is set to
/// what it does.
using AddCommand = void (*)(CLI::App& app, Devices devices, Action& action);

void add_captures(CLI::App& app, Devices devices, Action& action);
void add_completion(CLI::App& app, Devices devices, Action& action);
void add_conformance(CLI::App& app, Devices devices, Action& action);
void add_console(CLI::App& app, Devices devices, Action& action);
void add_decode(CLI::App& app, Devices devices, Action& action);
void add_devices(CLI::App& app, Devices devices, Action& action);
void add_doctor(CLI::App& app, Devices devices, Action& action);
void add_emulate(CLI::App& app, Devices devices, Action& action);
void add_fuzz(CLI::App& app, Devices devices, Action& action);
void add_kin(CLI::App& app, Devices devices, Action& action);
void add_lab(CLI::App& app, Devices devices, Action& action);
void add_latency(CLI::App& app, Devices devices, Action& action);
void add_record(CLI::App& app, Devices devices, Action& action);
void add_replay(CLI::App& app, Devices devices, Action& action);
void add_shadow(CLI::App& app, Devices devices, Action& action);
void add_trace(CLI::App& app, Devices devices, Action& action);
void add_watch(CLI::App& app, Devices devices, Action& action);
void add_wireshark(CLI::App& app, Devices devices, Action& action);

/// Prints the problem as one line on standard error and answers the exit code that goes with it.
[[nodiscard]] Exit report(const Problem& problem);

/// Prints a problem of an input; answers what wrong input is answered with.
[[nodiscard]] Exit refuse(const Problem& problem);

/// Has a subcommand set `action` to what it does, when it is the one chosen.
void when_chosen(CLI::App& command, Action& action, Action what);

/// Adds the argument that names the device. Whatever is said is taken: `find_device` refuses it in
/// its own words.
void add_device_argument(CLI::App& command, std::string& device, Devices devices);

/// A help text with `DEVICE` replaced by the name of the first device, so that its examples can be
/// tried.
[[nodiscard]] std::string with_example(std::string text, Devices devices);

}  // namespace armjig::cli
