// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "harness/core/error.hpp"
#include "harness/link/bus_port.hpp"
#include "harness/link/impaired_path.hpp"
#include "harness/link/impairment.hpp"
#include "harness/link/session_source.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/report/output_file.hpp"
#include "harness/rig/guarded_ports.hpp"
#include "harness/rig/stoppable_ports.hpp"
#include "harness/rig/target.hpp"
#include "harness/rig/wire_log.hpp"
#include "harness/rig/wiring.hpp"

namespace armjig {

/// What to do when the target disappears.
enum class WhenGone : std::uint8_t {
  kFail,
  kReopen,  ///< wait until it is back; only for looking at a real device
};

/// How a target is opened.
struct RigOptions {
  Target target;
  Permissions permissions;               ///< what may be sent to it, if it is not emulated
  std::optional<Impairment> impairment;  ///< a bad link on purpose
  CaptureFile capture;                   ///< for every byte that passes
  WhenGone when_gone{};
  WhenLeft when_left{};  ///< of a server
  MustStop must_stop;    ///< ends waiting for a device that is not emulated; empty: nothing does
};

/// A device on the jig, for `Port` as in `Wiring`. From the device outwards: its port, the
/// recording, the guard unless it is emulated, the impairments, and what lets it be stopped. So the
/// recording has what the device really got, the guard's own stops among it, and a flipped bit does
/// not slip past the guard. This is the one way by which programs get at a target.
template <class Port>
class Rig {
 public:
  /// With permission to move, call it, and connect to a server, while the program has one thread
  /// (see `Supervisor::start`). A target that moves may not be reopened: when it has gone, a person
  /// has to look at it (`kBadValue`). Problems: those of `open_target`; `kUnsupported` for an
  /// impairment that a bus cannot have; that of the recording.
  [[nodiscard]] static Outcome<Rig> open(const Wiring<Port>& wiring, const RigOptions& options);

  /// A rig of nothing but a port, without a guard: for devices in memory.
  explicit Rig(std::unique_ptr<Port> port) noexcept : port_{std::move(port)} {}

  [[nodiscard]] Port& port() noexcept { return *port_; }
  [[nodiscard]] const Port& port() const noexcept { return *port_; }

  /// Whether a guard stands between: one does, unless the device is emulated.
  [[nodiscard]] bool is_guarded() const noexcept { return watch_ != nullptr; }

  /// Why the guard last refused something or stopped the arm; none if it never did.
  [[nodiscard]] std::optional<Refusal> last_refusal() const {
    return watch_ == nullptr ? std::nullopt : watch_->last_refusal;
  }

  /// How often the guard refused something or stopped the arm.
  [[nodiscard]] std::size_t refusals() const { return watch_ == nullptr ? 0 : watch_->refusals; }

  /// Whether the arm was stopped because this program gave no sign of life, and may not move any
  /// more. It gives one now.
  [[nodiscard]] bool is_unsupervised() {
    if (watch_ == nullptr) return false;
    watch_->give_sign_of_life();
    return watch_->is_unsupervised;
  }

  /// Lets it move again: see `GuardState::resume`.
  [[nodiscard]] Result<void> resume() {
    return watch_ == nullptr ? Result<void>{} : watch_->resume();
  }

  /// What the impairments did, of all connections together; none if there are none.
  [[nodiscard]] std::optional<ImpairmentStatistics> impairments() const {
    return count_ ? std::optional{count_()} : std::nullopt;
  }

 private:
  template <class Other>
  friend class Rig;
  friend Outcome<Rig<StreamPort>> connect(Rig<SessionSource> server, const std::string& target,
                                          WhenGone when_gone);

  std::unique_ptr<Port> port_;
  std::shared_ptr<GuardState> watch_;            ///< none without a guard
  std::function<ImpairmentStatistics()> count_;  ///< none without impairments
};

extern template class Rig<StreamPort>;
extern template class Rig<SessionSource>;
extern template class Rig<BusPort>;

/// A connection to a server, its only one, as a byte stream. It is begun within two seconds; when
/// it has ended, so has the stream (`kFail`), or it is begun again (`kReopen`, not in virtual
/// time). `target` is for messages.
[[nodiscard]] Outcome<Rig<StreamPort>> connect(Rig<SessionSource> server, const std::string& target,
                                               WhenGone when_gone = WhenGone::kFail);

}  // namespace armjig
