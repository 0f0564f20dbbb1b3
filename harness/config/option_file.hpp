// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "harness/core/error.hpp"
#include "harness/core/option.hpp"

namespace armjig {

/// All of a file. Problems: `kCannotRead`.
[[nodiscard]] Outcome<std::string> read_text(const std::string& path);

/// The files of this machine, groups from TOML (`TomlTable::groups`).
[[nodiscard]] OptionFiles option_files();

}  // namespace armjig
