// SPDX-License-Identifier: Apache-2.0
// `armjig trace verify` without Boost, CLI11 and threads, so that it runs wherever the emulators
// do.
#include <fmt/core.h>

#include <cstddef>
#include <string>
#include <vector>

#include "emulators/replay/replay.hpp"
#include "harness/capture/trace.hpp"
#include "tests/portable/recorded_devices.hpp"

namespace {

/// What is wrong with one recording; empty if the emulator reproduces it.
std::string complaint_about(const std::string& path) {
  const auto trace = armjig::read_trace(path);
  if (!trace) return describe(trace.error());
  const auto* const device = armjig::test::recorded_device(*trace);
  if (device == nullptr) return path + ": no emulator replays '" + trace->device + "'";
  const auto difference = armjig::verify(*trace, device->replay);
  if (!difference) return describe(difference.error());
  if (!*difference) return "";
  return path + ": different\n" + describe(**difference, *trace, device->make_dissector);
}

}  // namespace

int main(int argc, char** argv) {
  const auto files = armjig::find_traces({argv + 1, argv + argc});
  if (!files) {
    fmt::print(stderr, "{}\n", describe(files.error()));
    return 2;
  }
  std::size_t identical = 0;
  for (const auto& file : *files) {
    const auto complaint = complaint_about(file);
    if (complaint.empty()) {
      ++identical;
    } else {
      fmt::print(stderr, "{}\n", complaint);
    }
  }
  fmt::print("{} of {} recordings identical\n", identical, files->size());
  return identical > 0 && identical == files->size() ? 0 : 1;
}
