// SPDX-License-Identifier: Apache-2.0
#include "harness/config/option_file.hpp"

#include "harness/config/toml_table.hpp"
#include "harness/files/user_file.hpp"

namespace armjig {

OptionFiles option_files() {
  return {
      .read_text = [](const std::string& path) { return read_user_file(path); },
      .read_groups =
          [](const std::string& path) {
            return TomlTable::read(path).and_then([](TomlTable table) { return table.groups(); });
          }};
}

}  // namespace armjig
