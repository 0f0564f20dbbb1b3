// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.hpp"
#include "harness/foreign/foreign.hpp"

namespace armjig::cli {

/// Where devices are in recordings of other programs.
struct ForeignOptions {
  std::vector<std::string> ports;
  std::string usb;
};

void add_foreign_options(CLI::App& command, ForeignOptions& options);

/// `device` is whose a port is that is given alone; empty: that of the only server. Problems:
/// `kBadValue`, `kUnknownDevice`.
[[nodiscard]] Outcome<ForeignHow> foreign_how(Devices devices, const ForeignOptions& options,
                                              std::string_view device);

/// A recording, or standard input if it is called `-`. Problems: those of the file.
[[nodiscard]] Outcome<std::unique_ptr<CaptureReader>> open_recording(const std::string& path,
                                                                     const ForeignHow& how);

/// On standard error, when all is read.
void print_warning_of(const CaptureReader& reader);

}  // namespace armjig::cli
