// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <vector>

#include "emulators/kinovazed/arm_port.hpp"
#include "emulators/kinovazed/behaviour.hpp"
#include "emulators/kinovazed/machine.hpp"
#include "harness/core/time.hpp"

namespace armjig::kinovazed::emulation {

/// What the network side may ask of the arm side; one job after the other.
struct Job {
  enum class Kind : std::uint8_t {
    kPoll,
    kWait,  ///< for its turn only
    kStop,
    kTakeControl,
    kReleaseControl,
    kInitialize,
    kUnfold,
    kRetract,
    kSetMode,
    kMove,
    kGoTo,
    kEvent,
  };
  Kind kind{};
  bool is_awaited = false;  ///< the network side stands still until it is done
  bool goes_on = false;     ///< with a command that has had a job before
  Instant posted{};
  Mode mode{};            ///< of `kSetMode`
  Deflection deflection;  ///< of `kMove`
  Pose target;            ///< of `kGoTo`
  ArmEvent event{};       ///< of `kEvent`
};

/// The server's supervision of the arm: one thread that looks at the arm every 10 ms and does one
/// job at a time (docs/spec/kinovazed.md, "Supervision of the arm"). A regular value on the virtual
/// clock.
class Worker {
 public:
  struct Report {
    enum class Kind : std::uint8_t {
      kNothing,
      kDone,       ///< an awaited job is done
      kEvent,      ///< decide what `event` does; what it needs of the arm is asked for by `then_*`
      kEventOver,  ///< what an event needed of the arm is done
      kAbort,      ///< an error that ends the process
    };
    Kind kind{};
    ArmEvent event{};
  };

  /// `late_repairs` decides races between threads: bit n is set if, the n-th time that a call fails
  /// in a command with more jobs to come, the next job overtakes the poll that repairs.
  Worker(ArmPort arm, const Behaviour& behaviour, Duration call_time, std::uint32_t late_repairs)
      : arm_{std::move(arm)},
        behaviour_{behaviour},
        call_time_{call_time},
        late_repairs_{late_repairs} {}

  /// Begins to look for the arm, as at the start of the process.
  void start(Instant now);
  /// The arm was found and looked at once.
  [[nodiscard]] bool is_started() const noexcept { return is_started_; }

  void post(Job job, Instant now);

  /// Goes on until there is something to report, or up to and including `limit`.
  [[nodiscard]] Report run_until(Instant limit);
  [[nodiscard]] Instant now() const noexcept { return now_; }
  /// When something happens if nothing more is posted; none: never.
  [[nodiscard]] std::optional<Instant> next_event() const noexcept;

  /// Whether a job that takes no time would be done at once.
  [[nodiscard]] bool is_free_at(Instant time) const noexcept {
    return !is_dead_ && !step_ && steps_.empty() && !job_ && jobs_.empty() && time < poll_due_;
  }

  // Between the reports `kEvent` and `kEventOver`, in this order.
  void then_stop();
  void then_go_to(const Pose& target);
  void then_release_control();

  /// The thread ends without a word: from now on no job is ever done (kinovazed.death.hang).
  void die() noexcept;
  [[nodiscard]] bool is_dead() const noexcept { return is_dead_; }

  /// How many races `late_repairs` has decided.
  [[nodiscard]] std::uint32_t repair_races() const noexcept { return repair_races_; }

  /// The arm is not flagged as failed.
  [[nodiscard]] bool is_arm_well() const noexcept { return !has_failed_; }
  /// As last polled and inside the workspace.
  [[nodiscard]] const Pose& pose() const noexcept { return pose_; }

  [[nodiscard]] ArmPort& arm() noexcept { return arm_; }
  [[nodiscard]] const ArmPort& arm() const noexcept { return arm_; }

 private:
  /// What jobs are made of. `Steps` in worker.cpp has a row for each.
  struct Steps;
  struct Row;
  struct Step {
    // NOLINTNEXTLINE(google-explicit-constructor): a list of steps is one of rows
    constexpr Step(const Row& row_of, std::uint16_t with = 0) noexcept
        : row{&row_of}, value{with} {}

    const Row* row;
    std::uint16_t value;  ///< an `ArmEvent`, or how often
  };

  /// What the server believes the arm to be doing.
  enum class Movement : std::uint8_t {
    kNone,
    kHoming,
    kInitializing,
    kRetracting,
    kHomingToRetract,
    kToTarget,
  };

  [[nodiscard]] bool comes_before_poll(Job& job) noexcept;
  void begin(const Job& job);
  [[nodiscard]] Report finish_job();
  void carry_out(Step step);

  /// Puts steps in front of those that are still to come, in this order.
  void next(std::initializer_list<Step> steps) {
    steps_.insert(steps_.end(), std::rbegin(steps), std::rend(steps));
  }
  void poll_before(Step step);
  [[nodiscard]] static Step tell(ArmEvent event) noexcept;
  void home(ArmEvent when_there);
  void check_settling();
  void forget_arm();

  // What follows steps.
  void go_on() noexcept {}
  void pause();
  void fail() noexcept { has_failed_ = true; }  ///< the next poll repairs
  void fail_without_next();
  void fail_or_abort() noexcept;
  void give_up() noexcept;
  void begin_to_poll();
  void search_again();
  void open_again();
  void note_start() noexcept;
  void note_control() noexcept { has_control_ = true; }
  void note_no_control() noexcept { has_control_ = false; }
  void note_mode();
  void note_target() noexcept;
  void guard_mode() noexcept;
  void take_pose();
  void take_mode();
  void take_current() noexcept;
  void initialize();
  void retract();
  void repair();
  void tell_of_repairs();
  void post_event();

  [[nodiscard]] Stick stick_of(const Deflection& deflection) const noexcept;
  [[nodiscard]] Deflection bounded(Deflection deflection) const noexcept;

  ArmPort arm_;
  Behaviour behaviour_;
  Duration call_time_;
  std::uint32_t late_repairs_;
  std::uint32_t repair_races_ = 0;
  Instant now_{};
  bool is_started_ = false;
  bool is_dead_ = false;
  bool aborts_ = false;

  std::deque<Job> jobs_;
  std::optional<Job> job_;
  std::vector<Step> steps_;  ///< the last one comes first
  std::vector<Step> asked_;  ///< by `then_*`, in order
  std::optional<Step> step_;
  std::uint16_t value_{};  ///< of the last step
  ArmData data_;           ///< of its call
  Instant step_ends_{};
  Instant poll_due_{};
  int attempts_ = 0;

  bool has_failed_ = false;
  bool has_control_ = false;
  bool has_pose_ = false;
  Pose pose_;
  std::optional<ArmMode> mode_;
  Movement movement_{};
  Pose target_;
  Mode joystick_mode_{};
  std::optional<Instant> mode_set_;  ///< kinovazed.mode.guard
  bool is_settling_ = false;
};

}  // namespace armjig::kinovazed::emulation
