// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "cli/device.hpp"
#include "cli/report_files.hpp"
#include "conformance/program_check.hpp"
#include "emulators/host/host.hpp"
#include "emulators/memory/hosted.hpp"
#include "harness/core/error.hpp"

/// What the subcommands share at which programs find a device.
namespace armjig::cli {

/// Where and how a device is served.
struct Serving {
  std::string device;
  HostOptions how;  ///< of a bus: its USB places; it has a device node if there is none
  int bus = 1;      ///< the N of /dev/i2c-N
  bool wants_json = false;
  bool is_quiet = false;  ///< no statistics at the end
};

/// With signals and a log, as servers have them.
[[nodiscard]] HostOptions server_options();

/// What an emulated device is called on USB: by the numbers of its entry or, if it has none, by
/// those that pid.codes keeps for trials.
[[nodiscard]] usb::Identity usb_identity(const Device& device, std::optional<UsbId> numbers);

/// Where `--listen` says: `pty:[PATH]`, `tcp:[HOST:]PORT`, `rfc2217:[HOST:]PORT`, `i2c:N`.
/// Problems: `kBadValue`, also for a place that is not for such a device.
[[nodiscard]] Outcome<Serving> parse_listen(const std::string& listen, const Device& device);

/// Says where it listens, and serves it until a signal comes. Lines on standard input do what can
/// be done beside it. Problems: those of `Host::open` and `VirtualI2c::open`.
[[nodiscard]] Outcome<void> serve(AnyHosted hosted, const Serving& serving);

/// What scheduling adds to the times of a program. `speed` is device time over wall time.
[[nodiscard]] LinkNoise link_noise_of(const Device& device, double speed);

/// Who judges the programs; nullptr if nobody asked. `speed` is device time over wall time.
/// Problems: those of `make_program_check`.
[[nodiscard]] Outcome<std::unique_ptr<ProgramCheck>> check_if(bool is_wanted, const Device& device,
                                                              double speed);

/// Adds `--check` with the files and colours of its report.
void add_program_check(CLI::App& command, bool& is_wanted, ReportFiles& files, std::string& colour);

/// The verdict: printed, and in the files that were asked for.
[[nodiscard]] Exit conclude(ProgramCheck& check, bool wants_json, const std::string& colour,
                            const ReportOutputs& files);

}  // namespace armjig::cli
