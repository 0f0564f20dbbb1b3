// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "cli/bus_session.hpp"

namespace armjig::cli {

struct MorapWatch {
  enum class Form : std::uint8_t { kScreen, kLines, kJson };

  TargetOptions target;
  double rate = 10;                      ///< rounds a second
  std::optional<std::uint64_t> count{};  ///< of rounds; none: until somebody ends it
  Form form{};
};

/// Shows what all nodes on a bus say of themselves: those that answer at its beginning.
[[nodiscard]] Exit watch_morap(const MorapWatch& options);

}  // namespace armjig::cli
