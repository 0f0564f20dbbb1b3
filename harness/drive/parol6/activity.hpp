// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/drive/parol6/drive.hpp"
#include "harness/drive/parol6/glide.hpp"

/// What takes longer than a frame: begun on a drive, it goes on while `step` is called after each
/// cycle, until telemetry shows that it was done, or why not. No I/O.
namespace armjig::parol6::drive {

class Activity {
 public:
  struct Ending {
    bool is_success{};
    std::string text;  ///< a sentence without a full stop
  };

  Activity() = default;
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;
  virtual ~Activity() = default;

  /// Call it after each cycle of the drive, with what happened in it, until it has ended. When it
  /// fails, the drive was told already to let the arm stand.
  [[nodiscard]] std::optional<Ending> step(Drive& drive, Instant now,
                                           std::span<const DriveEvent> events);

  /// How far it is, if there is more to say since the last call; else empty.
  [[nodiscard]] virtual std::string take_news() { return {}; }

  /// Whether the arm goes on moving after success.
  [[nodiscard]] virtual bool leaves_it_moving() const { return false; }

 protected:
  /// Called for each event. What ends here ends as failed unless it says otherwise.
  [[nodiscard]] virtual std::optional<Ending> take(Drive& drive, const DriveEvent& event);
  /// Called after each cycle with telemetry.
  [[nodiscard]] virtual std::optional<Ending> advance(Drive& drive, Instant now) = 0;
};

// Each begins one, and answers `kRefused` if the emergency stop is latched. The drive sends a frame
// each 10 ms.

/// Enable, disable or clear error: done when the board echoes it.
[[nodiscard]] Result<std::unique_ptr<Activity>> begin_command(Drive& drive, Command command);

/// Fails, and disables the board, if a joint does not come along or a minute does not suffice.
[[nodiscard]] Result<std::unique_ptr<Activity>> begin_home(Drive& drive);

/// Done as soon as the joint moves; it goes on moving then.
[[nodiscard]] Result<std::unique_ptr<Activity>> begin_jog(Drive& drive, std::size_t joint,
                                                          StepsPerSecond speed);

/// The same for a time, after which the joint stands again.
[[nodiscard]] Result<std::unique_ptr<Activity>> begin_jog_for(Drive& drive, std::size_t joint,
                                                              StepsPerSecond speed, Duration time);

/// Requires that telemetry has come.
[[nodiscard]] Result<std::unique_ptr<Activity>> begin_go_to(Drive& drive, const JointSteps& goal,
                                                            const JointSpeeds& fastest);

/// Makes the arm stand whatever it does. A homing can only be ended by disabling the board.
[[nodiscard]] std::unique_ptr<Activity> begin_stop(Drive& drive);

/// Both outputs at once, `io_flag::kOut1` and `kOut2`.
[[nodiscard]] std::unique_ptr<Activity> begin_outputs(Drive& drive, std::uint8_t flags);

/// Done when the fingers are there or have met something.
[[nodiscard]] std::unique_ptr<Activity> begin_gripper_move(Drive& drive,
                                                           const GripperSetPoint& set_point);

// They also make the next move a new one: the board sends a set-point only if it differs from the
// one before, and the gripper forgets its own.
[[nodiscard]] std::unique_ptr<Activity> begin_gripper_calibration(Drive& drive);
[[nodiscard]] std::unique_ptr<Activity> begin_gripper_clear(Drive& drive);

/// Nothing for a time; frames go on.
[[nodiscard]] std::unique_ptr<Activity> begin_wait(Duration time);

/// `j1 734 steps (6.4512 deg)`.
[[nodiscard]] std::string place_of(std::size_t joint, Steps position);

}  // namespace armjig::parol6::drive
