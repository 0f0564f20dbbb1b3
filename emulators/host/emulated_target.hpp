// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "emulators/faults/faulty.hpp"
#include "emulators/parol6/arm.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/target.hpp"

namespace armjig {

/// A device that `emulated:` can be.
struct EmulatedTarget {
  std::string_view device;
  OpenEmulated open;
};

/// All of them, by name.
[[nodiscard]] std::span<const EmulatedTarget> emulated_targets() noexcept;

/// The entry of a device that has one.
[[nodiscard]] const EmulatedTarget& emulated_target(std::string_view device) noexcept;

namespace parol6 {

using DeviceOptions = std::map<std::string, std::string, std::less<>>;

/// An emulated board as its options describe it: `profile=firmware`, `pass-us=N` (main loop period
/// in microseconds, 1 to 1000), `fault=KIND:FIELD` (several with `,` between them). `where` is for
/// messages. Problems: `kUnknownOption`, `kBadValue`.
[[nodiscard]] Outcome<Faulty<Arm>> make_arm(const DeviceOptions& options, const std::string& where);

}  // namespace parol6
}  // namespace armjig
