// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "emulators/faults/faulty.hpp"
#include "emulators/parol6/defects/defects.hpp"
#include "harness/core/error.hpp"
#include "harness/core/option.hpp"

namespace armjig::parol6::emulation {

[[nodiscard]] std::span<const OptionRow> options() noexcept;

/// A board with these options. `where` is for problems: `kUnknownOption`, `kBadValue`.
[[nodiscard]] Outcome<Faulty<DefectiveArm>> make(const DeviceOptions& options,
                                                 const std::string& where);

}  // namespace armjig::parol6::emulation
