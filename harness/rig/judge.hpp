// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"

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

/// Why something may not be sent, or why a device was stopped.
struct Refusal {
  enum class Cause : std::uint8_t {
    kRequest,       ///< what was asked for is not allowed
    kDevice,        ///< where the device is or went: at a bound, stopped by hand, out of sight
    kUnsupervised,  ///< nobody watches over it any more
  };

  /// Of cause `kDevice`: what is the matter with it.
  enum class Matter : std::uint8_t {
    kAstray,   ///< it is where it should not be, or goes there
    kStopped,  ///< its emergency stop is pressed, as far as it tells
    kUnseen,   ///< nobody can see where it is
  };

  Hazard hazard{};
  std::string reason;
  Cause cause{};
  Matter matter{};
};

/// A refusal unless the user agreed: `WHAT needs --allow HAZARD`.
[[nodiscard]] std::optional<Refusal> demand(Hazard hazard, const Permissions& permissions,
                                            std::string_view what);

/// What is sent at once, or has to be: one message on a byte stream or a connection, the messages
/// of a transaction on a bus. Each of those begins with the byte that has its address and
/// direction; a read has nothing else.
using Messages = std::span<const Bytes>;

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
  /// whatever was half sent before; they are no command. Sent, and judged, before anything else and
  /// after a write that failed. Empty where there is no need.
  [[nodiscard]] virtual Bytes opening_bytes() const { return {}; }
  /// Whether what was half sent before could become a command by what follows, so that they have to
  /// be sent.
  [[nodiscard]] virtual bool needs_opening() const { return !opening_bytes().empty(); }

  /// What time it is from now on, for whom that matters. Times never decrease.
  virtual void set_time(Instant /*now*/) {}

  /// Judges what is about to be sent. None: it may be, and the judge takes it that it is. With a
  /// refusal nothing of it must be sent.
  [[nodiscard]] virtual std::optional<Refusal> judge(Messages messages,
                                                     const Permissions& permissions) = 0;
  [[nodiscard]] std::optional<Refusal> judge(Bytes message, const Permissions& permissions) {
    return judge(Messages{&message, 1}, permissions);
  }

  /// Bytes that came from the device. On a bus: a message with what was read, or a write of which
  /// every byte was acknowledged.
  virtual void observe(Bytes bytes) = 0;

  /// Whether the device must be stopped now because of what was observed, and why: a joint at its
  /// bound, the emergency stop. Answers once for each reason.
  [[nodiscard]] virtual std::optional<std::string> must_stop() { return std::nullopt; }
  /// What the last reason that `must_stop` gave was about.
  [[nodiscard]] virtual Refusal::Matter matter_of_stop() const { return Refusal::Matter::kAstray; }

  /// Whether the device may be moving because of what was sent. Stays true until the device shows
  /// that it heard the end of it.
  [[nodiscard]] virtual bool may_be_moving() const = 0;

  /// What stops it, whatever was half sent before: a transaction for each message on a bus, whose
  /// devices that stand are left out. Harmless, whatever the permissions. Valid until the next call
  /// that changes the judge.
  [[nodiscard]] virtual Messages stop() const = 0;
};

/// The judge of a device on a byte stream or a connection, which one message stops.
class OneStopJudge : public Judge {
 public:
  [[nodiscard]] Messages stop() const final { return {&stop_, 1}; }

 protected:
  /// The message, which stays where it is; what it says may change.
  void stop_by(Bytes message) noexcept { stop_ = message; }

 private:
  Bytes stop_;
};

}  // namespace armjig
