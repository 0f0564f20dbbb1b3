// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "emulators/faults/named_fault.hpp"
#include "emulators/kinovazed/defects/quirks.hpp"
#include "emulators/kinovazed/server.hpp"
#include "harness/core/error.hpp"

namespace armjig::kinovazed::emulation {

/// Adds a fault of an emulated server as users write it:
///
///     row:STATE.VERB.STATE|rejected  a command leads to another state, or is refused
///     end:STATE.silent|ignored       what the arm reports there is not told, or has no effect
///     missing|twice|late|misspelled:WORD   a message does not leave, leaves twice, 700 ms late, in
///                                    small letters
///     bit-low|bit-high:BIT           of heartbeats, 0 to 7
///     swapped-bits:BIT+BIT
///     deaf:WORD                      a verb, mode or objective is not known
///     first-point:OBJECTIVE          the objective ends at its first way-point
///     behaviour:NAME                 one difference of the profile turned round
///     figure:NAME                    a wrong time or distance
///     quirk:NAME                     a behaviour that was written by hand
///     rare:NAME                      one that no suite asks for
///
/// Problems: `kBadValue`.
[[nodiscard]] Outcome<void> add_fault(std::string_view text, ServerOptions& options,
                                      std::vector<Quirk>& quirks);

/// Every fault that there is, as `add_fault` reads it.
[[nodiscard]] std::vector<NamedFault> all_faults();

}  // namespace armjig::kinovazed::emulation
