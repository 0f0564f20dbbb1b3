// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "conformance/kinovazed/chapters.hpp"
#include "conformance/kinovazed/server_bench.hpp"
#include "conformance/kinovazed/ways.hpp"
#include "conformance/kinovazed/wording.hpp"

/// What the files in chapters/ begin with.
namespace armjig::kinovazed::conformance {

using namespace std::chrono_literals;

}  // namespace armjig::kinovazed::conformance
