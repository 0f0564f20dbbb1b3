// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/wire/dissection.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig::parol6 {

/// Finds frames as the strict receiver does, commands one way and telemetry the other. What lies
/// between them is reported as `noise` with the reason why it is no frame.
[[nodiscard]] std::unique_ptr<Dissector> make_dissector();

[[nodiscard]] Dissection dissection();

}  // namespace armjig::parol6
