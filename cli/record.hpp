// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/capture_options.hpp"
#include "cli/command.hpp"
#include "cli/report_files.hpp"
#include "cli/shadowing.hpp"

namespace armjig::cli {

/// What `armjig record` is told, as written.
struct RecordOptions {
  std::string device;
  std::string listen;
  std::string target;
  CaptureOptions capture;
  bool wants_json = false;
  bool wants_check = false;
  bool is_quiet = false;  ///< says nothing but what went wrong
  ShadowOptions shadow;
  ReportFiles files;
  std::string colour;
};

/// Stands between a program and a device until a signal comes.
[[nodiscard]] Exit record(Devices devices, const RecordOptions& options);

}  // namespace armjig::cli
