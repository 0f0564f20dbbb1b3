// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/wire/dissection.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig::morap {

/// A dissector for a bus with motor nodes and the pen. Each call of `feed` takes one transaction:
/// the byte with address and direction, then the data bytes, acknowledged ones only. The direction
/// of a message is that of this byte, whatever `feed` is told. What was chosen to be read is
/// remembered for every address, from the state after power-on. Bytes behind a message are noise.
[[nodiscard]] std::unique_ptr<Dissector> make_dissector();

[[nodiscard]] Dissection dissection();

}  // namespace armjig::morap
