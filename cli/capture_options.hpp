// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/device.hpp"
#include "emulators/memory/overheard.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/wire_log.hpp"

namespace armjig::cli {

/// What every subcommand with a wire is told of its recording, as written.
struct CaptureOptions {
  std::string file;
  std::string rotate;
  bool is_redacted = false;
  std::optional<CaptureFormat> format{};  ///< none: by the ending of the file
};

/// Adds `--rotate`, `--redact`, and before them the file, which it answers.
CLI::Option* add_capture_options(CLI::App& app, CaptureOptions& options,
                                 const std::string& file = "--capture");

/// Reads the options and opens the file. Problems: `kBadValue`, and those of `open_output`.
[[nodiscard]] Outcome<CaptureFile> open_capture_file(std::string_view option,
                                                     const CaptureOptions& options);

/// Overhears a device that is served to programs, and records it.
class HostedCapture {
 public:
  /// Of nothing if no file is asked for.
  [[nodiscard]] static Outcome<HostedCapture> open(const CaptureFile& file, const Device& device,
                                                   const std::string& target,
                                                   std::int64_t epoch_ns);

  /// The same device, overheard if something is recorded. `this` may be moved, and must outlive it.
  template <class Hosted>
  [[nodiscard]] std::unique_ptr<Hosted> watch(std::unique_ptr<Hosted> device) {
    return log_ ? overhear(std::move(device), *log_) : std::move(device);
  }

 private:
  std::unique_ptr<Overhearer> log_;
};

}  // namespace armjig::cli
