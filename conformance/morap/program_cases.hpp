// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/morap/cases.hpp"

/// What the cases about sets of parameters have in common.
namespace armjig::morap::conformance {

// Messages without their identifier, from the reference's worked examples.
inline constexpr std::string_view kGood =
    "00 90 01 02 00 00 80 3F 00 00 00 40 02 00 00 80 3F 00 00 00 40 01 00 00 00 BF 00 00 00 00";

inline constexpr std::string_view kGoodSum = " A9";

inline constexpr std::string_view kSpeedSet =
    "01 40 01 01 00 00 00 3F 01 00 00 00 3F 01 00 00 00 BF 00 00 80 3E BD";

inline constexpr std::string_view kOtherKind =
    "02 71 02 01 00 00 80 3F 01 00 00 80 3F 01 00 00 00 00 00 00 00 00 08";

inline void program(NodeBench& node, std::string_view set, std::string_view checksum = "") {
  node.send_bytes(fmt::format("20 {}{}", set, checksum));
}

inline std::string good() { return std::string{kGood}.append(kGoodSum); }

}  // namespace armjig::morap::conformance
