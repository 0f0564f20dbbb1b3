// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "emulators/parol6/can.hpp"
#include "harness/core/emulation.hpp"
#include "harness/core/quantity.hpp"
#include "harness/core/time.hpp"

namespace armjig::parol6::emulation {

/// What the fingers meet. Places are position bytes (0 open, 255 closed) of an uncalibrated
/// gripper. Fingers that are beyond such a place already stay where they are.
struct GripperPlant {
  std::optional<std::uint8_t> stop_closing{};  ///< something between the fingers
  std::optional<std::uint8_t> stop_opening{};  ///< something around them, gripped from inside
  bool has_end_stops = true;                   ///< false: the motor turns free of the fingers

  friend bool operator==(const GripperPlant&, const GripperPlant&) = default;
};

struct GripperOptions {
  std::uint8_t node = 0;       ///< on the CAN, 0 to 15
  std::uint8_t position = 0;   ///< where the fingers stand at the start
  bool is_calibrated = false;  ///< at the start
  GripperPlant plant{};

  friend bool operator==(const GripperOptions&, const GripperOptions&) = default;
};

struct EncoderUnit {
  static constexpr auto symbol = "counts";
};
/// Of the motor's encoder, 16384 a turn.
using EncoderCounts = Quantity<EncoderUnit, std::int32_t>;

/// A frame that the gripper puts on the CAN, complete at `time`.
struct CanEmission {
  Instant time{};
  CanFrame frame;
};

/// How long a frame occupies a 1 Mbit/s CAN: 44 bits and its data. Stuff bits, at most one in five,
/// are left out, so that the time does not depend on the content.
[[nodiscard]] constexpr Duration can_frame_time(std::size_t data_size) noexcept {
  return std::chrono::microseconds{44 + 8 * data_size};
}
/// What must pass before the next frame begins.
inline constexpr Duration kCanPause = std::chrono::microseconds{3};

/// An SSG-48 gripper at the board's CAN, for use where no recording tells what a gripper answered.
/// A regular value on virtual time: a copy is a snapshot, same inputs give the same answers.
///
/// What the drive decides is from docs/spec/parol6.md, "Gripper". The mechanics are our model: the
/// motor reaches a speed at once, needs `kFreeCurrent` to move the fingers and its whole limit when
/// they are held up. The drive's 5 kHz interrupt is where everything happens; stretches in which
/// an interrupt only repeats the one before are computed in closed form.
class Gripper : public Sending<CanEmission> {
 public:
  static constexpr Duration kTick = std::chrono::microseconds{200};
  static constexpr Milliamperes kFreeCurrent{60};

  explicit Gripper(const GripperOptions& options = {});

  /// A frame that the board hands to its CAN at `time`. It waits for its turn on the bus and acts
  /// when it has come whole; while it waits, a further one is lost, because the board writes to one
  /// mailbox and does not look whether that is free. Times of all inputs and of `advance_to` must
  /// not decrease.
  void receive(Instant time, const CanFrame& frame);

  void advance_to(Instant time);

  /// When the next answer will be complete.
  [[nodiscard]] std::optional<Instant> next_event() const noexcept;

  /// Puts something between the fingers at `time`, or takes it away.
  void touch(Instant time, const GripperPlant& plant);
  [[nodiscard]] const GripperPlant& plant() const noexcept { return options_.plant; }

  /// Power off and on at `time`: the fingers stay, all else is as at the start.
  void reboot(Instant time);

  /// Encoder count as of the last interrupt, positive toward open.
  [[nodiscard]] EncoderCounts position() const noexcept;
  /// What an answer would say now.
  [[nodiscard]] std::uint8_t position_byte() const noexcept;
  /// Of the motor, positive toward open.
  [[nodiscard]] Milliamperes current() const noexcept {
    return Milliamperes{static_cast<std::int16_t>(current_)};
  }
  [[nodiscard]] std::uint8_t status() const noexcept;
  [[nodiscard]] bool is_calibrated() const noexcept { return is_calibrated_; }
  [[nodiscard]] bool is_calibrating() const noexcept { return mode_ == Mode::kCalibrating; }

  /// For tests: computes every interrupt by itself.
  void use_plain_loop() noexcept { uses_plain_loop_ = true; }

 private:
  /// Encoder counts times the interrupt rate: at a whole speed the fingers move whole units in an
  /// interrupt, so positions stay exact.
  using Units = std::int64_t;

  enum class Mode : std::uint8_t { kIdle, kFollowing, kCalibrating };
  enum class Phase : std::uint8_t { kOpening, kPausing, kClosing };
  enum class Object : std::uint8_t { kNone, kClosing, kOpening, kAtPosition };

  struct SetPoint {
    std::uint8_t position{};
    std::uint8_t speed{};
    std::int16_t current{};
    std::uint8_t command{};  ///< `gripper_command` flags

    friend bool operator==(const SetPoint&, const SetPoint&) = default;
  };
  struct Calibration {
    Phase phase{};
    std::int64_t elapsed{};  ///< interrupts since it began
    std::int64_t stalled{};  ///< interrupts in a row at the current limit and standing
    std::int64_t paused{};
    EncoderCounts open_end{};  ///< found
  };
  /// A request on its way, and the answer to it.
  struct Exchange {
    Instant handled{};
    std::optional<Instant> answered;
    CanFrame frame;  ///< the request, later the answer
    bool is_handled = false;
  };
  /// What the drive wants of the motor.
  struct Effort {
    std::int32_t direction{};  ///< +1 opens
    Units speed{};             ///< in an interrupt, positive
    Units until_goal{};        ///< it stops there by itself
    std::int32_t limit{};      ///< mA, positive
  };
  /// What comes of it in one interrupt.
  struct Motion {
    Units step{};  ///< signed
    std::int32_t current{};
    bool is_blocked = false;
  };

  void handle(const CanFrame& request);
  void take_set_point(const CanFrame& request) noexcept;
  void begin_calibration() noexcept;
  void stop_if_estop() noexcept;
  [[nodiscard]] CanFrame answer() const noexcept;

  void run_to(Instant time);
  void tick() noexcept;
  void calibration_tick() noexcept;
  void end_calibration(EncoderCounts closed_end) noexcept;
  [[nodiscard]] std::int64_t repetitions() const noexcept;
  void repeat_tick(std::int64_t times) noexcept;

  [[nodiscard]] std::optional<Effort> effort() const noexcept;
  [[nodiscard]] Motion motion_of(const Effort& effort) const noexcept;
  [[nodiscard]] Units room(std::int32_t direction) const noexcept;
  [[nodiscard]] Units last_step() const noexcept;
  [[nodiscard]] bool is_stalled() const noexcept;
  [[nodiscard]] bool has(std::uint8_t command) const noexcept;
  [[nodiscard]] Object object() const noexcept;

  static constexpr std::size_t kVelocitySamples = 20;

  GripperOptions options_;
  std::int64_t ticks_ = 0;  ///< interrupts since time 0
  Units position_{};
  std::array<Units, kVelocitySamples> steps_{};  ///< the last ones, a ring
  std::size_t oldest_step_ = 0;
  Units sum_of_steps_ = 0;
  std::size_t alike_ = 0;     ///< how many interrupts did the same, up to the last; at most 20
  std::int32_t current_ = 0;  ///< mA, fits in 16 bits

  EncoderCounts open_end_;    ///< position byte 0
  EncoderCounts closed_end_;  ///< position byte 255
  Mode mode_ = Mode::kIdle;
  SetPoint set_point_{};
  Calibration calibration_{};
  bool is_calibrated_;
  bool is_at_position_ = false;
  bool has_estop_error_ = false;
  bool uses_plain_loop_ = false;

  Instant bus_is_free_{};
  Instant mailbox_is_free_{};
  std::vector<Exchange> under_way_;
};

}  // namespace armjig::parol6::emulation
