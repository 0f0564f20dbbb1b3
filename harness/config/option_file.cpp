// SPDX-License-Identifier: Apache-2.0
#include "harness/config/option_file.hpp"

#include <fstream>
#include <iterator>

#include "harness/config/toml_table.hpp"

namespace armjig {

Outcome<std::string> read_text(const std::string& path) {
  std::ifstream in{path, std::ios::binary};
  if (!in) return problem(ErrorCode::kCannotRead, path, "check the path and its permissions");
  in.peek();  // does not throw, as the iterator does
  if (in.bad()) return problem(ErrorCode::kCannotRead, path, "it is a folder or cannot be read");
  return std::string{std::istreambuf_iterator<char>{in}, {}};
}

OptionFiles option_files() {
  return {.read_text = read_text, .read_groups = [](const std::string& path) {
            return TomlTable::read(path).and_then([](TomlTable table) { return table.groups(); });
          }};
}

}  // namespace armjig
