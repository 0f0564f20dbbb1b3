// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "cli/capture_options.hpp"
#include "cli/device.hpp"
#include "conformance/program_check.hpp"
#include "emulators/host/relay.hpp"
#include "emulators/memory/hosted.hpp"
#include "harness/core/error.hpp"
#include "harness/core/overhearer.hpp"
#include "harness/link/impairment.hpp"
#include "harness/rig/target.hpp"

namespace armjig::cli {

/// A device as programs shall meet it.
struct PresentHow {
  Target target;                           ///< emulated, or where the real one is
  CaptureFile capture;                     ///< of what passes
  double speed = 1;                        ///< device time over wall time
  Overhearer* witness = nullptr;           ///< of the same
  std::optional<Impairment> impairment{};  ///< between all this and the programs
  ProgramCheck* check = nullptr;           ///< judges the programs
};

/// A device to be hosted, emulated or at the other end of a link, with all that is around it. From
/// the device outwards: recording, witness, impairments, judge. Must outlive what is hosted.
class Presented {
 public:
  /// Problems: those of the device's options, of opening the target, `kUnsupported` for a bus that
  /// is not emulated and for impairments that its link cannot have, that of the recording.
  [[nodiscard]] static Outcome<std::unique_ptr<Presented>> open(const Device& device,
                                                                const PresentHow& how);

  /// The device. Once.
  [[nodiscard]] AnyHosted take() noexcept { return std::move(hosted_); }

  /// Of a device that is not emulated. For after the end of what is hosted.
  [[nodiscard]] const RelayStatistics& relayed() const noexcept { return relayed_; }

 private:
  Presented() = default;

  RelayStatistics relayed_;
  HostedCapture capture_;
  AnyHosted hosted_;
};

}  // namespace armjig::cli
