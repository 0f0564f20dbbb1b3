// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/option.hpp"

namespace armjig {

/// The files of this machine, groups from TOML (`TomlTable::groups`).
[[nodiscard]] OptionFiles option_files();

}  // namespace armjig
