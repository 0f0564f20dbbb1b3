// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "cli/device.hpp"

namespace armjig::cli {

/// A check of the programs that talk to a device, which says on standard error what they do wrong:
/// the first few times of each, with the name of the
/// device unless that is empty. Problems: `kBadValue` if nothing is demanded of them.
[[nodiscard]] Outcome<std::unique_ptr<ProgramCheck>> make_program_check(const Device& device,
                                                                        const LinkNoise& noise,
                                                                        std::string_view name = {});

}  // namespace armjig::cli
