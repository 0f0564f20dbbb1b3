// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armjig::script {

/// As one line; text that is not UTF-8 has replacement characters. `Json` is the library's.
template <class Json>
[[nodiscard]] std::string json_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace armjig::script
