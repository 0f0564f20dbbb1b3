// SPDX-License-Identifier: Apache-2.0
#include "harness/core/nesting.hpp"

namespace armjig {

bool is_too_deep(std::string_view json) noexcept {
  std::size_t depth = 0;
  bool is_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char letter = json[i];
    if (is_text) {
      if (letter == '\\') ++i;
      if (letter == '"') is_text = false;
    } else if (letter == '"') {
      is_text = true;
    } else if (letter == '[' || letter == '{') {
      if (++depth > kDeepestNesting) return true;
    } else if ((letter == ']' || letter == '}') && depth > 0) {
      --depth;
    }
  }
  return false;
}

}  // namespace armjig
