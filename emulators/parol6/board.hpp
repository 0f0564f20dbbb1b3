// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "emulators/parol6/can.hpp"
#include "emulators/parol6/command_receiver.hpp"
#include "emulators/parol6/figures.hpp"
#include "emulators/parol6/homing.hpp"
#include "emulators/parol6/joint.hpp"
#include "emulators/parol6/plant.hpp"
#include "emulators/parol6/profile.hpp"
#include "harness/core/bytes.hpp"
#include "harness/core/emulation.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::emulation {

/// The clocks of one particular board.
struct BoardTiming {
  /// Of the main loop, 1 us to 1 s; the real one is not published.
  std::chrono::microseconds pass_period{10};
  std::uint32_t micros_at_start = 740'000;  ///< microsecond clock at time 0: start-up delays
  Ticks timer_at_start{};                   ///< interval counter at time 0
  std::uint8_t timer_bits = 16;             ///< its width, 1 to 32

  friend bool operator==(const BoardTiming&, const BoardTiming&) = default;
};

/// What the board sent.
struct Emission {
  Instant time{};
  std::variant<TelemetryBytes, CanFrame> what;
};

/// The PAROL6 control board on a virtual clock: with `kFirmwareBoard` the shipped one, byte for
/// byte, otherwise one that differs from it as its profile says. A regular value: a copy is a
/// snapshot. Same inputs at the same times give the same bytes.
///
/// The firmware is one endless loop. In a pass, time stands still: it acts on the last command,
/// then takes at most one CAN frame, then reads all bytes that have come and answers every frame
/// among them. Passes that only repeat themselves are computed in closed form, so the cost follows
/// steps and frames, not passes.
class Board : public Sending<Emission> {
 public:
  explicit Board(const Plant& plant, const BoardTiming& timing = {},
                 const BoardProfile& profile = kFirmwareBoard, const BoardFigures& figures = {});

  /// Bytes that become readable at `time`. Runs the passes before `time` first. Times of all
  /// inputs and of `advance_to` must not decrease.
  void receive(Instant time, Bytes bytes);
  void receive_can(Instant time, const CanFrame& frame);

  /// Runs every pass up to and including one at `time`.
  void advance_to(Instant time);

  /// The next pass that may send something without further input; none if nothing waits to be
  /// handled.
  [[nodiscard]] std::optional<Instant> next_event() const noexcept;

  /// When the pass ends in whose middle the board sleeps (parol6.demo.sleeps): all that this pass
  /// sends has that time. None while it is awake.
  [[nodiscard]] std::optional<Instant> wakes_at() const noexcept;

  /// Power off and on: all state but the plant is lost, and for the 0.74 s of the start-up delays
  /// whatever arrives waits. Homed bits go, the outputs too.
  void reboot(Instant time);

  /// Changes the surroundings at `time`: presses the stop, toggles an input, moves an axis by hand.
  /// `change` gets a `Plant&`.
  template <class Change>
  void touch(Instant time, Change change) {
    run_before(time);
    auto plant = this->plant();
    change(plant);
    set_plant(plant);
  }
  [[nodiscard]] Plant plant() const noexcept;

  [[nodiscard]] std::span<const Joint, kJointCount> joints() const noexcept { return joints_; }
  [[nodiscard]] const Homing& homing() const noexcept { return homing_; }
  [[nodiscard]] bool is_enabled() const noexcept { return is_enabled_; }
  /// Told to home, and not there yet.
  [[nodiscard]] bool is_homing() const noexcept { return home_wanted_ && !home_finished_; }
  [[nodiscard]] std::uint8_t outputs() const noexcept { return latched_.in_out; }

  /// For tests and benchmarks: computes every pass by itself, as the firmware does.
  void use_plain_loop() noexcept {
    uses_plain_loop_ = true;
    outlook_ = Outlook::kOpen;
  }

 private:
  enum class DemoLeg : std::uint8_t { kWaiting, kOut, kBack, kDone };
  enum class Next : std::uint8_t { kCommunicate, kSleep };
  /// What is known of the passes to come.
  enum class Outlook : std::uint8_t {
    kOpen,     ///< the next one has to be computed
    kStill,    ///< no joint moves
    kSteady,   ///< joints move, and nothing about it can be noticed
    kWatched,  ///< joints move until the firmware notices a switch or an arrival
  };

  void run_before(Instant time);
  void run_passes(std::int64_t last);
  [[nodiscard]] bool is_waiting_for_pass() const noexcept;

  // Acting on the latched command.
  [[nodiscard]] Next control(std::int64_t pass);
  [[nodiscard]] Next act(Micros now);
  [[nodiscard]] Outlook outlook() const noexcept;
  [[nodiscard]] std::int64_t coast(std::int64_t last);
  void idle() noexcept;
  void home(Micros now) noexcept;
  void jog(Micros now) noexcept;
  void go_to(Micros now) noexcept;
  [[nodiscard]] bool is_held_at_bound(std::size_t joint, StepsPerSecond speed) const noexcept;
  [[nodiscard]] Next demo(Micros now) noexcept;
  [[nodiscard]] bool run_all(Micros now) noexcept;
  void end_homing() noexcept;
  void begin_motion() noexcept;
  [[nodiscard]] bool is_stopped_by_hand() const noexcept;
  void watch_silence() noexcept;

  // The link and the gripper's bus.
  void communicate(std::int64_t pass);
  void accept(std::int64_t pass, CommandReceiver::Body body);
  void send_gripper_frame(std::int64_t pass);
  void take_gripper_answer(const CanFrame& frame) noexcept;
  void send_telemetry(std::int64_t pass, std::uint16_t interval);
  [[nodiscard]] GripperReport gripper_report() const noexcept;
  [[nodiscard]] std::uint8_t joints_out_of_range() const noexcept;

  [[nodiscard]] std::uint32_t timer(std::int64_t pass) const noexcept;
  [[nodiscard]] Micros clock(std::int64_t pass) const noexcept;
  void set_plant(const Plant& plant) noexcept;

  BoardProfile profile_;
  BoardFigures figures_;
  BoardTiming timing_;
  std::int64_t start_ = 0;      ///< virtual microseconds at which the main loop was entered
  std::int64_t next_pass_ = 0;  ///< virtual microseconds
  std::array<Joint, kJointCount> joints_;
  Inputs inputs_;

  // Latched from the last accepted frame.
  CommandFrame latched_{};
  std::array<std::byte, kCommandBodySize> latched_body_{};
  GripperSetPoint gripper_sent_{};
  std::uint32_t timer_at_frame_ = 0;

  // The firmware's own state.
  bool is_enabled_ = true;
  bool home_wanted_ = false;
  bool home_finished_ = false;
  Homing homing_;
  bool is_home_served_ = false;  ///< with `homes_once`: done, and the same command is still latched
  DemoLeg demo_leg_ = DemoLeg::kWaiting;
  bool is_asleep_ = false;   ///< the demo sleeps in the middle of a pass
  bool is_settled_ = false;  ///< the last pass would repeat itself
  Outlook outlook_ = Outlook::kOpen;
  bool uses_plain_loop_ = false;

  // Of profiles that mind them.
  std::int64_t silence_ends_ = kNoPass;  ///< the last pass in which a command still acts
  bool is_silent_ = false;               ///< no frame came in time
  std::uint8_t position_errors_ = 0;     ///< `flag(joint)`

  CommandReceiver receiver_;
  GripperReport gripper_{};
  std::vector<std::byte> bytes_waiting_;
  std::vector<CanFrame> can_waiting_;
};

}  // namespace armjig::parol6::emulation
