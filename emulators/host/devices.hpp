// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "emulators/host/hosted_stream.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/target.hpp"

namespace armjig {

/// `NAME=VALUE`, the same as behind the question mark of an `emulated:` target.
using HostedOptions = decltype(Target::options);

/// A device that can be hosted on a byte stream. `make` names `where` the options came from in its
/// problems: `kUnknownOption`, `kBadValue`.
struct HostEntry {
  std::string_view device;
  Outcome<std::unique_ptr<HostedStream>> (*make)(const HostedOptions& options,
                                                 const std::string& where);
};

/// All of them. This is the room's one list of devices.
[[nodiscard]] std::span<const HostEntry> hosted_devices() noexcept;

/// Problems: those of `make`, and `kUnknownDevice` with the names of all devices.
[[nodiscard]] Outcome<std::unique_ptr<HostedStream>> make_hosted_device(
    const std::string& device, const HostedOptions& options = {});

}  // namespace armjig
