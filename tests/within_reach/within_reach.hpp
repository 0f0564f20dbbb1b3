// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "cli/device.hpp"
#include "conformance/bench.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/target.hpp"

namespace armjig::test {

/// The bench of an emulated device that is reached as real ones are: a guard stands between,
/// everything is permitted, and only its link is there, but for the inputs that `has_input` tells,
/// which somebody beside it sets. Time stays virtual. One at a time; `device` outlives it.
[[nodiscard]] Outcome<std::unique_ptr<Bench>> bench_within_reach(
    const cli::Device& device, const Target& emulated,
    std::function<bool(std::string_view input)> has_input);

}  // namespace armjig::test
