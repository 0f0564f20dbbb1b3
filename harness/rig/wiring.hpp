// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "harness/core/error.hpp"
#include "harness/link/serial_line.hpp"
#include "harness/rig/judge.hpp"
#include "harness/rig/target.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// What the jig must know of a device. `Port` is what stands for its link: `StreamPort`,
/// `SessionSource` (a server) or `BusPort`.
template <class Port>
struct Wiring {
  std::string_view device;
  std::unique_ptr<Dissector> (*make_dissector)();
  std::unique_ptr<Judge> (*make_judge)();
  /// Makes an emulated one from the target's options. Emulators are above this room.
  std::function<Outcome<std::unique_ptr<Port>>(const Target&)> open_emulated;
  /// Opens a real one: `open_target` of programs that have real links; nullptr: there are none.
  Outcome<std::unique_ptr<Port>> (*open_real)(const Target& target, const SerialLine& line){};
  SerialLine line{};  ///< of streams, where the target does not say something else
};

}  // namespace armjig
