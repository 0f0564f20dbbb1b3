// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "emulators/memory/hosted.hpp"
#include "emulators/replay/replay.hpp"
#include "harness/core/option.hpp"

namespace armjig::mutation {

/// What a shared object with an emulator in it gives to its judge. The object hides everything
/// else, so that judge and judged have their own copy of each function.
struct Judged {
  Outcome<Replayed> (*replay)(const Trace& trace){};
  Outcome<AnyHosted> (*emulate)(const DeviceOptions& options, const std::string& where){};
};

inline constexpr auto kEntry = "armjig_judged";

}  // namespace armjig::mutation
