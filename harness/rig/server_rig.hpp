// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "harness/core/error.hpp"
#include "harness/link/impaired_session.hpp"
#include "harness/link/session_port.hpp"
#include "harness/rig/rig.hpp"
#include "harness/rig/session_guard.hpp"

namespace armjig {

/// Makes the port of an emulated server from the target's options; registered as `OpenEmulated` is.
using OpenEmulatedSession = Outcome<std::unique_ptr<SessionPort>> (*)(const Target& target);

/// `Rig` for a server: its port, the wire log, the guard unless it is emulated, the impairments.
class ServerRig {
 public:
  /// Nothing is connected yet. `device` must be one that this room knows. Problems: `kBadTarget`
  /// for what is neither `emulated:` nor `tcp:HOST:PORT`, and that of the wire log.
  [[nodiscard]] static Outcome<ServerRig> open(std::string_view device, const RigOptions& options,
                                               OpenEmulatedSession open_emulated);

  [[nodiscard]] SessionPort& port() noexcept { return *port_; }
  [[nodiscard]] const SessionPort& port() const noexcept { return *port_; }

  /// Why the guard last refused a write; none if it never did.
  [[nodiscard]] std::optional<Refusal> last_refusal() const;

  /// What the impairments did; none if there are none.
  [[nodiscard]] std::optional<ImpairmentStatistics> impairments() const;

 private:
  std::unique_ptr<SessionPort> port_;
  const GuardedSession* guard_ = nullptr;      ///< inside `port_`
  const ImpairedSession* impaired_ = nullptr;  ///< inside `port_`
};

}  // namespace armjig
