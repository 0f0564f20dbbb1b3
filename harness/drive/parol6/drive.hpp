// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/core/quantity.hpp"
#include "harness/core/time.hpp"
#include "harness/drive/parol6/motion_monitor.hpp"
#include "harness/timing/latency_histogram.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "harness/wire/parol6/splitter.hpp"

namespace armjig::parol6::drive {

/// What happened on the link. A frame is lost if no answer came that could be its own.
struct DriveStatistics {
  std::uint64_t sent = 0;
  std::uint64_t answered = 0;
  std::uint64_t late = 0;  ///< answered, but after the next frame was sent
  std::uint64_t lost = 0;
  std::uint64_t bad = 0;      ///< pieces of telemetry that were no frame
  std::uint64_t surplus = 0;  ///< answers that nobody asked for
  LatencyHistogram round_trip;
};

/// Something that the user of a drive should know.
struct DriveEvent {
  enum class Kind : std::uint8_t {
    kEstopPressed,   ///< latched: only disable frames leave from now on
    kEstopReleased,  ///< still latched
    kLinkSilent,     ///< no telemetry for half a second
    kLinkBack,       ///< nothing that was under way before the silence goes on by itself
    kTookEffect,     ///< telemetry shows what was asked for
    kNoEffect,       ///< it does not
    kNothingMoved,   ///< the command was accepted, but the joint stands
    kStillMoves,     ///< the joint moves although it was stopped
    kHomed,
  };
  Kind kind{};
  Instant time{};
  Command command{};                   ///< that the event is about
  std::optional<std::size_t> joint{};  ///< from 0
};

/// For people: `nothing moved: j3 stands although jog was accepted`.
[[nodiscard]] std::string describe(const DriveEvent& event);

/// The host side of a PAROL6 board, without I/O: calls and received bytes go in, a frame for each
/// period and events come out. It trusts nothing: every request is verified by telemetry, and the
/// emergency stop latches here because the board only reports it (docs/spec/parol6.md).
class Drive {
 public:
  explicit Drive(Duration period = kFramePeriod) noexcept : period_{period} {}

  // Requests; each replaces the one before and leaves with the next frame. `kRefused` while the
  // emergency stop is latched, but for `enable`, `disable` and `idle`.
  void idle() noexcept;
  [[nodiscard]] Result<void> jog(const JointSpeeds& speeds) noexcept;
  [[nodiscard]] Result<void> go_to(const JointSteps& goal, const JointSpeeds& feed) noexcept;
  [[nodiscard]] Result<void> home() noexcept;
  [[nodiscard]] Result<void> clear_error() noexcept;
  void disable() noexcept;
  /// Also ends the latch, if the stop is released; `kRefused` while it is pressed.
  [[nodiscard]] Result<void> enable() noexcept;

  // What goes along with every frame.
  void set_outputs(std::uint8_t flags) noexcept;                ///< `io_flag::kOut1`, `kOut2`
  void set_gripper(const GripperSetPoint& set_point) noexcept;  ///< its mode leaves once

  /// The frame that is due at `now`. Call once a period.
  [[nodiscard]] CommandBytes tick(Instant now);

  /// What came from the board.
  void receive(Instant now, Bytes bytes);

  /// The newest telemetry; none before the first.
  [[nodiscard]] const std::optional<TelemetryFrame>& telemetry() const noexcept {
    return telemetry_;
  }
  [[nodiscard]] bool is_latched() const noexcept { return is_latched_; }
  [[nodiscard]] bool is_homing() const noexcept { return homing_ != Homing::kNo; }
  [[nodiscard]] const DriveStatistics& statistics() const noexcept { return statistics_; }

  /// Frames whose answer may still come; they count as lost if it does not.
  [[nodiscard]] std::size_t outstanding() const noexcept { return outstanding_.size(); }
  /// Counts them as lost now, at the end of a run.
  void give_up_outstanding() noexcept;

  /// What happened since the last call.
  [[nodiscard]] std::vector<DriveEvent> take_events();

 private:
  enum class Homing : std::uint8_t { kNo, kAsked, kRuns };

  /// A command that is sent until its echo comes.
  struct OneShot {
    Command command{};
    std::optional<Instant> deadline{};  ///< none before its first frame left
  };

  void take(Instant now, const TelemetryFrame& frame);
  void request(Command command) noexcept;
  void request_once(Command command) noexcept;
  [[nodiscard]] Command due_command(Instant now);
  void check_estop(Instant now, const TelemetryFrame& frame);
  void check_one_shot(Instant now, const TelemetryFrame& frame);
  void check_homing(Instant now, const TelemetryFrame& frame);
  void check_motion(Instant now, const TelemetryFrame& frame);
  void match_answer(Instant now) noexcept;
  void count_lost(Instant now) noexcept;
  void add_event(DriveEvent::Kind kind, Instant now, Command command,
                 std::optional<std::size_t> joint = std::nullopt);

  Duration period_;
  Splitter splitter_{kTelemetryPayloadSize};
  CommandFrame frame_ = first_frame();
  std::optional<TelemetryFrame> telemetry_;
  Instant last_telemetry_{};
  bool is_silent_ = false;

  bool is_latched_ = false;
  bool is_estop_pressed_ = false;
  Homing homing_ = Homing::kNo;
  bool has_seen_unhomed_ = false;
  std::optional<OneShot> one_shot_;
  MotionMonitor monitor_;
  std::optional<Command> monitored_;  ///< the command that the monitor watches
  std::uint8_t gripper_mode_ = 0;     ///< for the next frame only

  std::deque<Instant> outstanding_;  ///< when frames without an answer were sent
  DriveStatistics statistics_;
  std::vector<DriveEvent> events_;

  static CommandFrame first_frame() noexcept {
    CommandFrame frame;
    frame.command = Command::kIdle;
    frame.check = kCheckHost;
    return frame;
  }
};

}  // namespace armjig::parol6::drive
