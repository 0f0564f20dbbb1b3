// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "emulators/demo/demo.hpp"
#include "emulators/faults/faulty.hpp"
#include "harness/core/error.hpp"
#include "harness/core/option.hpp"

namespace armjig::demo::emulation {

[[nodiscard]] std::span<const OptionRow> options() noexcept;

/// A device with these options. `where` is for problems: `kUnknownOption`, `kBadValue`.
[[nodiscard]] Outcome<Faulty<StreamDevice>> make(const DeviceOptions& options,
                                                 const std::string& where);

}  // namespace armjig::demo::emulation
