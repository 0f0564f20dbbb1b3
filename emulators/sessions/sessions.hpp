// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

/// The session of a seed, for each device: a recording (`golden-trace/1`) of all that is done to it
/// and nothing that it does. The same text with every compiler.
namespace armjig {

using DrawSession = std::string (*)(std::uint64_t seed);

namespace parol6::sessions {
[[nodiscard]] std::string draw(std::uint64_t seed);
}
namespace morap::sessions {
[[nodiscard]] std::string draw(std::uint64_t seed);
}
namespace kinovazed::sessions {
[[nodiscard]] std::string draw(std::uint64_t seed);
}

}  // namespace armjig
