// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "harness/core/error.hpp"
#include "harness/link/bus_port.hpp"
#include "harness/rig/bus_guard.hpp"
#include "harness/rig/rig.hpp"

namespace armjig {

/// Makes the port of an emulated bus from the target's options.
using OpenEmulatedBus = Outcome<std::unique_ptr<BusPort>> (*)(const Target& target);

/// Opens the bus that a target names: `emulated:`, `i2c:/dev/i2c-N`, `i2c-tiny-usb:[SERIAL]`.
/// Problems name the target and say what to do.
[[nodiscard]] Outcome<std::unique_ptr<BusPort>> open_bus(const Target& target,
                                                         OpenEmulatedBus open_emulated);

/// `Rig` for devices on a bus: the port, the wire log, the guard unless it is emulated, the
/// impairments, which only an emulated bus can have.
class BusRig {
 public:
  /// `device` must be one that this room knows. Problems: those of `open_bus`, and `kUnsupported`
  /// for what a bus cannot have.
  [[nodiscard]] static Outcome<BusRig> open(std::string_view device, const RigOptions& options,
                                            OpenEmulatedBus open_emulated);

  [[nodiscard]] BusPort& port() noexcept { return *port_; }

  /// Why the guard last refused a transaction; none if it never did.
  [[nodiscard]] std::optional<Refusal> last_refusal() const;

 private:
  std::unique_ptr<BusPort> port_;
  const GuardedBus* guard_ = nullptr;  ///< inside `port_`
};

}  // namespace armjig
