// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/capture/capture.hpp"
#include "harness/core/overhearer.hpp"

namespace armjig {

/// Tells somebody what a record says, as if it passed now. CAN frames, and events that are about
/// something else, are passed over. Where nobody says what was acknowledged on a bus, all was.
void tell(const CaptureRecord& record, Overhearer& overhearer);

}  // namespace armjig
