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
};
inline constexpr std::size_t kHazardCount = 5;

[[nodiscard]] std::string_view to_string(Hazard hazard) noexcept;

/// The hazards that the user agreed to; observing is always among them.
class Permissions {
 public:
  constexpr void add(Hazard hazard) noexcept { bits_ |= bit(hazard); }
  [[nodiscard]] constexpr bool allow(Hazard hazard) const noexcept {
    return (bits_ & bit(hazard)) != 0;
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

/// Reads `--allow`: `state,move,home,grip` in any choice, or `all`. Problems: `kBadValue`.
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

  /// Judges bytes that are about to be written. None: they may be, and the judge takes it that they
  /// are. With a refusal nothing of them must be written.
  [[nodiscard]] virtual std::optional<Refusal> judge(Bytes bytes,
                                                     const Permissions& permissions) = 0;

  /// Bytes that came from the device.
  virtual void observe(Bytes bytes) = 0;

  /// Whether the device must be stopped now because of what was observed, and why: a joint at its
  /// bound, the emergency stop. Answers once.
  [[nodiscard]] virtual std::optional<std::string> must_stop() = 0;

  /// Whether the device may be moving because of what was written.
  [[nodiscard]] virtual bool may_be_moving() const = 0;

  /// What stops it. Sent again and again until it stands.
  [[nodiscard]] virtual std::vector<std::byte> stop_bytes() const = 0;
};

/// A device that this room knows.
struct JudgeEntry {
  std::string_view device;
  std::unique_ptr<Judge> (*make)();
};

/// All of them, by name.
[[nodiscard]] std::span<const JudgeEntry> judges() noexcept;

/// Stands before every write to a device that is not emulated, whoever writes. A write that is
/// refused fails with `kForbidden`, and `last_refusal` says why. When the arm stops being safe it
/// sends the stop by itself; so does its destructor if the device may be moving.
class GuardedStream final : public StreamPort {
 public:
  /// With permission to move or home, a port that has a descriptor gets a supervisor; call it while
  /// the program has one thread then. Errors: those of `Supervisor::start`.
  [[nodiscard]] static Result<std::unique_ptr<GuardedStream>> guard(
      std::unique_ptr<StreamPort> port, std::unique_ptr<Judge> judge, Permissions permissions);
  ~GuardedStream() override;

  Result<void> write(Bytes bytes) override;
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override;
  [[nodiscard]] Instant now() const override { return port_->now(); }
  [[nodiscard]] std::optional<int> descriptor() const override { return port_->descriptor(); }

  [[nodiscard]] const std::optional<Refusal>& last_refusal() const noexcept { return refusal_; }

 private:
  GuardedStream(std::unique_ptr<StreamPort> port, std::unique_ptr<Judge> judge,
                Permissions permissions, std::optional<Supervisor> supervisor);
  void stop();

  std::unique_ptr<StreamPort> port_;
  std::unique_ptr<Judge> judge_;
  Permissions permissions_;
  std::optional<Supervisor> supervisor_;
  std::optional<Refusal> refusal_;
};

}  // namespace armjig
