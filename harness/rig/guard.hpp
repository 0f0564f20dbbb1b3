// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/rig/judge.hpp"
#include "harness/rig/supervisor.hpp"

namespace armjig {

class Guard;

/// What a guard does when a connection ends while the arm may be moving. Losing a client stops no
/// server's arm.
enum class WhenLeft : std::uint8_t {
  kStop,        ///< before it ends, however it does
  kSayNothing,  ///< for those who look at what happens then. But a port that goes with its
                ///< connection stops the arm first, and the last of all does if another left it
                ///< moving
};

/// What all guards of a rig have in common. A server has a guard for each connection.
class GuardState {
 public:
  /// Why one of them last refused something or stopped the device; none if none ever did.
  std::optional<Refusal> last_refusal;
  std::size_t refusals = 0;  ///< how many there were
  /// A supervisor has stopped the device or was ended; `last_refusal` said so.
  bool is_unsupervised = false;
  WhenLeft when_left{};          ///< of a server
  bool has_left_moving = false;  ///< a client of one, and nothing was stopped since

  /// Tells the supervisors of all of them that this program lives.
  void give_sign_of_life();

  /// After a supervisor has stopped the device: each guard without one gets another, and permits
  /// again what it did at first. For those who know why this program was silent, and what state
  /// the device is in now. Does nothing as long as all is well. Errors: as for `Guard::begin`.
  [[nodiscard]] Result<void> resume();

 private:
  friend class Guard;
  std::vector<Guard*> guards_;
};

/// Stands before everything that is sent to a device that is not emulated, whoever sends; what is
/// put around the ports (guarded_ports.hpp) is made of it. What is refused fails with `kForbidden`,
/// and `last_refusal` says why. When the device stops being safe, or something is refused while it
/// may be moving, the guard stops it by itself; so it is when the port goes.
///
/// It watches the device at every call, also if nobody reads. While the device may be moving, at
/// least two calls a second are due to any guard of the rig, or the supervisor stops it.
class Guard {
 public:
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  [[nodiscard]] const std::optional<Refusal>& last_refusal() const noexcept {
    return watch_->last_refusal;
  }
  [[nodiscard]] bool is_unsupervised() const noexcept { return is_unsupervised_; }

  /// For who measures times, and writes to the file of the port and reads from it without anything
  /// between (direct_line.hpp): admits a message that is then sent by the caller, before anything
  /// else. What came meanwhile is to be read from the port. Errors: as for sending it.
  [[nodiscard]] Result<void> announce(Bytes message) { return admit({&message, 1}); }
  /// What was read in that way. The guard stops the device if it has to.
  void overhear(Bytes bytes) {
    hear(bytes);
    look();
  }

 protected:
  /// How often a stop leaves, until the device shows that it heard it, and how far apart.
  struct Patience {
    int stops{};
    Duration between{};
  };

  Guard(std::unique_ptr<Judge> judge, Permissions permissions, std::shared_ptr<GuardState> watch,
        Patience patience);
  ~Guard();

  /// Hands over one message of the judge's.
  [[nodiscard]] virtual Result<void> put(Bytes message) = 0;
  /// Waits for what comes, but not beyond `deadline`; shows it to the judge and keeps it.
  [[nodiscard]] virtual Result<void> listen(Instant deadline) = 0;
  /// The same after a stop.
  [[nodiscard]] virtual Result<void> settle(Instant deadline) { return listen(deadline); }
  [[nodiscard]] virtual Instant time() const = 0;

  /// Before anything else. With permission to move or home, a port with a file gets a supervisor;
  /// call it while the program has one thread then. Errors: those of `Supervisor::start` and of the
  /// port.
  [[nodiscard]] Result<void> begin(const std::optional<Lifeline>& line);
  /// Ends the supervision, if whatever had to be stopped is.
  void end();

  /// Before something is sent. Errors: those of the port, and `kForbidden`.
  [[nodiscard]] Result<void> admit(Messages messages);
  /// Admits and sends it.
  [[nodiscard]] Result<void> send_guarded(Bytes message);
  [[nodiscard]] Result<void> take_in(Instant deadline);
  /// After something was sent or observed.
  void look();
  void stop_if_moving();
  void stop();  ///< whoever moved it
  [[nodiscard]] bool may_be_moving() const { return judge_->may_be_moving(); }

  /// What the device sent.
  void hear(Bytes bytes);

  [[nodiscard]] Judge& judge() noexcept { return *judge_; }
  [[nodiscard]] GuardState& watch() noexcept { return *watch_; }

 private:
  friend class GuardState;
  [[nodiscard]] Supervisor::Motion motion() const;
  [[nodiscard]] Result<void> supervise();
  [[nodiscard]] Result<void> resume();
  [[nodiscard]] Result<void> fall_into_step();
  [[nodiscard]] Result<void> hand_over(Bytes message);
  void refuse(Refusal refusal);
  void report_life();
  void report_change();

  std::unique_ptr<Judge> judge_;
  Permissions granted_;
  Permissions permissions_;  ///< what is left of them
  std::optional<Lifeline> line_;
  std::shared_ptr<GuardState> watch_;
  Patience patience_;
  std::optional<Supervisor> supervisor_;
  Supervisor::Motion told_motion_ = Supervisor::Motion::kNone;
  bool is_in_step_ = false;       ///< the judge knows what the device's receiver holds
  bool is_unsupervised_ = false;  ///< the supervisor is gone
};

}  // namespace armjig
