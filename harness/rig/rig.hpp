// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "harness/core/error.hpp"
#include "harness/link/impaired_stream.hpp"
#include "harness/link/impairment.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/rig/guard.hpp"
#include "harness/rig/target.hpp"

namespace armjig {

/// What to do when the target disappears.
enum class WhenGone : std::uint8_t {
  kFail,
  kReopen,  ///< wait until it is back; only for looking at a real device
};

/// How a target is opened.
struct RigOptions {
  Target target;
  Permissions permissions;               ///< what may be written to it, if it is not emulated
  std::optional<Impairment> impairment;  ///< a bad link on purpose
  std::string wire_log;                  ///< a file for every byte on the wire; empty: none
  WhenGone when_gone{};
};

/// A device on the jig. From the device outwards: its port, the wire log, the guard unless it is
/// emulated, the impairments. So the log has what the device really got, the guard's own stops
/// among it, and a flipped bit does not slip past the guard. This is the one way by which programs
/// get at a target.
class Rig {
 public:
  /// `device` must be one that this room knows. With permission to move, call it while the program
  /// has one thread (see `GuardedStream::guard`). A target that moves may not be reopened: when it
  /// has gone, a person has to look at it (`kBadValue`).
  [[nodiscard]] static Outcome<Rig> open(std::string_view device, const RigOptions& options,
                                         OpenEmulated open_emulated);

  /// A rig of nothing but a port, without a guard: for devices in memory.
  explicit Rig(std::unique_ptr<StreamPort> port) noexcept : port_{std::move(port)} {}

  [[nodiscard]] StreamPort& port() noexcept { return *port_; }
  [[nodiscard]] const StreamPort& port() const noexcept { return *port_; }

  /// Why the guard last refused a write or stopped the arm; none if it never did.
  [[nodiscard]] std::optional<Refusal> last_refusal() const;

  /// The arm was stopped because this program gave no sign of life, and may not move any more.
  [[nodiscard]] bool is_unsupervised() const;

  /// What the impairments did; none if there are none.
  [[nodiscard]] std::optional<ImpairmentStatistics> impairments() const;

 private:
  std::unique_ptr<StreamPort> port_;
  const GuardedStream* guard_ = nullptr;      ///< inside `port_`
  const ImpairedStream* impaired_ = nullptr;  ///< inside `port_`
};

}  // namespace armjig
