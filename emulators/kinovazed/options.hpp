// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "emulators/kinovazed/defects/defective_server.hpp"
#include "harness/core/error.hpp"
#include "harness/core/option.hpp"

namespace armjig::kinovazed::emulation {

[[nodiscard]] std::span<const OptionRow> options() noexcept;

/// A server with these options. `where` is for problems: `kUnknownOption`, `kBadValue`, and
/// `kMalformed` for a file, which needs `files` to be read.
[[nodiscard]] Outcome<DefectiveServer> make(const DeviceOptions& options, const std::string& where,
                                            const OptionFiles& files = {});

}  // namespace armjig::kinovazed::emulation
