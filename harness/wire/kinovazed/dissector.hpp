// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/wire/dissection.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig::kinovazed {

/// Reads one connection with the eyes of the shipped server: commands to it, events and heartbeats
/// from it, and every other line with what is wrong with it. How bytes are cut makes no difference.
[[nodiscard]] std::unique_ptr<Dissector> make_dissector();

[[nodiscard]] Dissection dissection();

}  // namespace armjig::kinovazed
