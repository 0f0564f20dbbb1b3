// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/drive/kinovazed/drive.hpp"
#include "harness/link/session_port.hpp"

namespace armjig::kinovazed::drive {

/// What may end the wait for a command.
struct CallOptions {
  std::optional<Duration> time{};      ///< for all of it; none: what the drive gives it
  std::function<bool()> is_cancelled;  ///< asked ten times a second and behind all that comes
};

/// How a call came back.
struct CallResult {
  enum class Kind : std::uint8_t {
    kEnded,      ///< as `ending` says
    kCancelled,  ///< by `is_cancelled`; what was under way is ended on the server, too
    kTimedOut,   ///< `time` is over; the arm may go on
  };
  Kind kind{};
  Ending ending{};

  [[nodiscard]] bool is_done() const noexcept {
    return kind == Kind::kEnded && ending == Ending::kDone;
  }
  friend bool operator==(const CallResult&, const CallResult&) = default;
};

/// A drive on its connection: commands are calls that come back when they are over on the arm. A
/// connection that ended or went silent is begun anew, but nothing is asked for again: who lost one
/// looks at the next beat. For one thread; in virtual time if the port has it.
class Client {
 public:
  /// Connects with the first `poll`. `port` must outlive it and have no connection.
  explicit Client(SessionPort& port, DriveOptions options = {}) noexcept
      : port_{port}, drive_{options} {}
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  /// Lets the stick go and waits for replies on their way, because the shipped server goes mute for
  /// ever when a client leaves before (kinovazed.death.mute). The arm may go on moving.
  ~Client();

  /// Connects and waits for the first beat. Errors: those of the port, and `kTimedOut`: no beat
  /// until then, for the server is mute or serves somebody else.
  [[nodiscard]] Result<void> connect(Instant deadline);

  // Each waits until the command is over. Errors: `kForbidden` (the guard), `kDisconnected` (no
  // connection, `connect` or `poll` first), `kBusy` (`begin` has a reply to come).
  [[nodiscard]] Result<CallResult> call(const Command& command, const CallOptions& how = {});
  [[nodiscard]] Result<CallResult> estop() { return call({.verb = Verb::kEStop}); }
  [[nodiscard]] Result<CallResult> quit_estop() { return call({.verb = Verb::kQuitEStop}); }
  [[nodiscard]] Result<CallResult> initialize(const CallOptions& how = {}) {
    return call({.verb = Verb::kInitialize}, how);
  }
  [[nodiscard]] Result<CallResult> retract(const CallOptions& how = {}) {
    return call({.verb = Verb::kRetract}, how);
  }
  [[nodiscard]] Result<CallResult> unfold(const CallOptions& how = {}) {
    return call({.verb = Verb::kUnfold}, how);
  }
  [[nodiscard]] Result<CallResult> freeze() { return call({.verb = Verb::kFreeze}); }
  [[nodiscard]] Result<CallResult> unfreeze() { return call({.verb = Verb::kUnfreeze}); }
  [[nodiscard]] Result<CallResult> set_joystick_mode(Mode mode) {
    return call({.verb = Verb::kSetJoystickMode, .mode = mode});
  }
  /// Renew it within `DriveOptions::stick_watchdog`, or the stick is let go.
  [[nodiscard]] Result<CallResult> move_joystick(const Deflection& deflection) {
    return call({.verb = Verb::kMoveJoystick, .deflection = deflection});
  }
  [[nodiscard]] Result<CallResult> run_objective(Objective objective, const CallOptions& how = {}) {
    return call({.verb = Verb::kRunObjective, .objective = objective}, how);
  }

  /// Sends a command without waiting; `take_events` tells how it ended. Errors as for `call`.
  [[nodiscard]] Result<RequestId> begin(const Command& command);
  /// `Drive::cancel`, sent.
  [[nodiscard]] Result<std::optional<RequestId>> cancel();
  /// Takes in what comes until `deadline`, or until something has happened that `take_events`
  /// tells. Without a connection, or with one that fell silent, it begins a new one, which takes a
  /// second at most. Errors: why there is none; try again a little later.
  [[nodiscard]] Result<void> poll(Instant deadline);
  /// What happened beside calls, since the last call.
  [[nodiscard]] std::vector<DriveEvent> take_events();
  /// `listener` gets everything that the server says, as it comes.
  void on_bytes(std::function<void(Instant, Bytes)> listener) { listener_ = std::move(listener); }

  [[nodiscard]] const Drive& drive() const noexcept { return drive_; }
  [[nodiscard]] Instant now() const { return port_.now(); }

 private:
  [[nodiscard]] Result<void> flush();
  [[nodiscard]] Result<void> open(Instant deadline);
  void receive(Instant deadline);
  void drop();
  void collect();
  [[nodiscard]] std::optional<Ending> take_ending(RequestId request);

  SessionPort& port_;
  Drive drive_;
  std::vector<DriveEvent> events_;  ///< that nobody has taken
  std::function<void(Instant, Bytes)> listener_;
};

}  // namespace armjig::kinovazed::drive
