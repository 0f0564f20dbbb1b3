// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "harness/core/error.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::cli {

/// A connection to the KinovaZED server that the options name, as a byte stream, for who only
/// listens; the guard stands before it. Problems: those of `ServerRig::open` and of connecting.
[[nodiscard]] Outcome<Rig> open_kinova_stream(const RigOptions& options);

}  // namespace armjig::cli
