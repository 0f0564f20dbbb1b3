// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace armjig::kinovazed {

/// Takes an offence: the requirement's id, and what the program did, in one sentence.
using Complain = std::function<void(std::string_view requirement, std::string what)>;

}  // namespace armjig::kinovazed
