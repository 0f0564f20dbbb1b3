// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "harness/wire/morap/message.hpp"

namespace armjig::morap::emulation {

/// In what the public document and the shipped firmware differ. All differences are here; whatever
/// is not, both do alike. Each cites its row of docs/spec/morap.md, section Contradictions.
struct Profile {
  bool has_brake;                ///< 1: identifier 15 shorts a disabled motor, 14 releases it
  bool has_undocumented;         ///< 2: identifiers that the document does not list do something
  std::uint8_t last_node;        ///< 3: with a larger identifier the node stays silent
  bool refuses_other_kinds;      ///< 12: of controllers than position and speed
  bool refuses_zero_rate;        ///< 13: of a controller
  bool refuses_unstable_tuning;  ///< 15: a pole of 0 and no inertia
};

inline constexpr Profile kFirmware{false, true, kLastNode, false, false, false};
inline constexpr Profile kDocumented{true, false, kLastDocumentedNode, true, true, true};

}  // namespace armjig::morap::emulation
