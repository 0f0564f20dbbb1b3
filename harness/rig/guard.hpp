// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/rig/supervisor.hpp"

namespace armjig {

/// What a message can do to a device and to who stands near it.
enum class Hazard : std::uint8_t {
  kObserve,  ///< only answers
  kState,    ///< enables, disables, clears, switches outputs
  kMove,
  kHome,  ///< moves far, to switches that have to work
  kGrip,
  kProgram,  ///< changes parameters that outlast the program
  kCrash,    ///< ends or hangs the device's program; somebody may have to start it again
};
inline constexpr std::size_t kHazardCount = 7;

[[nodiscard]] std::string_view to_string(Hazard hazard) noexcept;

/// The hazards that the user agreed to; observing is always among them.
class Permissions {
 public:
  constexpr void add(Hazard hazard) noexcept { bits_ |= bit(hazard); }
  constexpr void withdraw_motion() noexcept { bits_ &= ~(bit(Hazard::kMove) | bit(Hazard::kHome)); }
  [[nodiscard]] constexpr bool allow(Hazard hazard) const noexcept {
    return (bits_ & bit(hazard)) != 0;
  }
  [[nodiscard]] constexpr bool allow_motion() const noexcept {
    return allow(Hazard::kMove) || allow(Hazard::kHome);
  }
  [[nodiscard]] static constexpr Permissions all() noexcept {
    Permissions permissions;
    permissions.bits_ = (1U << kHazardCount) - 1;
    return permissions;
  }

 private:
  static constexpr unsigned bit(Hazard hazard) noexcept {
    return 1U << static_cast<unsigned>(hazard);
  }
  unsigned bits_ = bit(Hazard::kObserve);
};

/// Reads `--allow`: `state,move,home,grip,program,crash` in any choice, or `all`. Problems:
/// `kBadValue`.
[[nodiscard]] Outcome<Permissions> parse_permissions(std::string_view text);

/// Why something may not be written.
struct Refusal {
  Hazard hazard{};
  std::string reason;
};

/// Knows one device's protocol well enough to judge what the device would do with bytes. It sees
/// everything that passes both ways, and reads the host's bytes with the device's own eyes, so that
/// a forbidden command cannot hide in garbage.
class Judge {
 public:
  Judge() = default;
  Judge(const Judge&) = delete;
  Judge& operator=(const Judge&) = delete;
  virtual ~Judge() = default;

  /// Bytes that leave every receiver, the device's and the judge's, in one and the same state,
  /// whatever was half sent before; they are no command. Written, and judged, before anything else
  /// and after a write that failed.
  [[nodiscard]] virtual Bytes opening_bytes() const = 0;

  /// Judges bytes that are about to be written. None: they may be, and the judge takes it that they
  /// are. With a refusal nothing of them must be written.
  [[nodiscard]] virtual std::optional<Refusal> judge(Bytes bytes,
                                                     const Permissions& permissions) = 0;

  /// Bytes that came from the device.
  virtual void observe(Bytes bytes) = 0;

  /// Whether the device must be stopped now because of what was observed, and why: a joint at its
  /// bound, the emergency stop. Answers once for each reason.
  [[nodiscard]] virtual std::optional<std::string> must_stop() = 0;

  /// Whether the device may be moving because of what was written. Stays true until the device
  /// shows that it heard the end of it.
  [[nodiscard]] virtual bool may_be_moving() const = 0;

  /// What stops it, whatever was half sent before. Harmless, whatever the permissions. Valid until
  /// the next `judge`.
  [[nodiscard]] virtual Bytes stop_bytes() const = 0;
};

/// A device that this room knows.
struct JudgeEntry {
  std::string_view device;
  std::unique_ptr<Judge> (*make)();
};

/// All of them, by name.
[[nodiscard]] std::span<const JudgeEntry> judges() noexcept;

/// Stands before every write to a device that is not emulated, whoever writes. A write that is
/// refused fails with `kForbidden`, and `last_refusal` says why. When the arm stops being safe, or
/// a write is refused while it may be moving, the guard stops it by itself; so does its destructor
/// if the device may be moving.
///
/// It watches the device at every call, also if nobody reads: `write` takes in what has arrived and
/// keeps it for `read`.
class GuardedStream final : public StreamPort {
 public:
  /// With permission to move or home, a port that has a descriptor gets a supervisor; call it while
  /// the program has one thread then. Errors: those of `Supervisor::start` and of the port.
  [[nodiscard]] static Result<std::unique_ptr<GuardedStream>> guard(
      std::unique_ptr<StreamPort> port, std::unique_ptr<Judge> judge, Permissions permissions);
  ~GuardedStream() override;

  /// While the arm may be moving, at least two calls a second of this or `read` are due, or the
  /// supervisor stops it.
  Result<void> write(Bytes bytes) override;
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override;
  [[nodiscard]] Instant now() const override { return port_->now(); }
  [[nodiscard]] std::optional<int> descriptor() const override { return port_->descriptor(); }

  /// Why it last refused a write or stopped the arm; none if it never did.
  [[nodiscard]] const std::optional<Refusal>& last_refusal() const noexcept { return refusal_; }

  /// The supervisor has stopped the arm or was ended; `last_refusal` says so.
  [[nodiscard]] bool is_unsupervised() const noexcept { return is_unsupervised_; }

 private:
  GuardedStream(std::unique_ptr<StreamPort> port, std::unique_ptr<Judge> judge,
                Permissions permissions, std::optional<Supervisor> supervisor);
  [[nodiscard]] Result<void> take_in(Instant deadline);
  [[nodiscard]] Result<void> receive(Instant deadline);
  [[nodiscard]] Result<void> put(Bytes bytes);
  [[nodiscard]] Result<void> fall_into_step();
  [[nodiscard]] Supervisor::Motion motion() const;
  void report_life(Supervisor::Motion motion);
  void report_motion();
  void stop();

  std::unique_ptr<StreamPort> port_;
  std::unique_ptr<Judge> judge_;
  Permissions permissions_;
  std::optional<Supervisor> supervisor_;
  std::vector<std::byte> told_stop_;  ///< what the supervisor would send
  Supervisor::Motion told_motion_ = Supervisor::Motion::kNone;
  std::optional<Refusal> refusal_;
  std::vector<std::byte> unread_;  ///< arrived, and nobody asked for it yet
  bool is_in_step_ = false;        ///< the judge knows what the device's receiver holds
  bool is_unsupervised_ = false;   ///< the supervisor is gone
};

}  // namespace armjig
