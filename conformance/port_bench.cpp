// SPDX-License-Identifier: Apache-2.0
#include "conformance/port_bench.hpp"

#include <fmt/core.h>

namespace armjig {

std::string line_of(const Message& message) {
  return fmt::format("{:.3f} ms {}", static_cast<double>(microseconds(message.time)) / 1000.0,
                     to_text(message));
}

}  // namespace armjig
