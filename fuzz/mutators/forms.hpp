// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fuzz/mutators/messages.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/parol6/dissector.hpp"

/// The inputs of the targets that take what passes on a wire, by the name of the target.
namespace armjig::fuzz::forms {

inline constexpr InputForm parol6_splitter{parol6::make_dissector, 1};
inline constexpr InputForm kinovazed_server{kinovazed::make_dissector, 1};

}  // namespace armjig::fuzz::forms
