// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/worker.hpp"

#include <algorithm>
#include <utility>

namespace armjig::kinovazed::emulation {
namespace {

constexpr std::uint16_t kPauseMs = 10;        // after press, release, zero axes, erase
constexpr std::uint16_t kLongPressMs = 200;   // from mode 4: the arm overlooks a shorter one
constexpr std::uint16_t kReopenPauseMs = 50;  // between attempts to open the arm again
constexpr int kStartAttempts = 120;
constexpr float kHighestCurrent = 4.5F;  // ampere, all joints together

std::chrono::milliseconds milliseconds(std::uint16_t count) noexcept {
  return std::chrono::milliseconds{count};
}

}  // namespace

void Worker::start(Instant now) {
  now_ = now;
  push(Step::Kind::kFindArm);
  job_ = Job{};
}

void Worker::post(Job job, Instant now) {
  job.posted = now;
  jobs_.push_back(job);
}

std::optional<Instant> Worker::next_event() const noexcept {
  if (is_dead_) return std::nullopt;
  if (step_) return step_ends_;
  if (job_ || !jobs_.empty()) return now_;
  return std::max(now_, poll_due_);
}

Worker::Report Worker::run_until(Instant limit) {
  using Kind = Report::Kind;
  while (!is_dead_) {
    if (step_) {
      if (step_ends_ > limit) break;
      now_ = std::max(now_, step_ends_);
      carry_out(*std::exchange(step_, std::nullopt));
      if (std::exchange(aborts_, false)) return {Kind::kAbort};
    } else if (!steps_.empty()) {
      step_ = steps_.back();
      steps_.pop_back();
      step_ends_ = now_ + duration(*step_);
    } else if (job_) {
      const auto report = finish_job();
      if (report.kind != Kind::kNothing) return report;
    } else if (!jobs_.empty() && comes_before_poll(jobs_.front())) {
      if (jobs_.front().posted > limit) break;
      now_ = std::max(now_, jobs_.front().posted);
      begin(jobs_.front());
      jobs_.pop_front();
      if (job_->kind == Job::Kind::kEvent) return {Kind::kEvent, job_->event};
    } else {
      if (poll_due_ > limit) break;
      now_ = std::max(now_, poll_due_);
      begin({.kind = Job::Kind::kPoll});
    }
  }
  // Dying breaks the promise that the network side waits for, which frees it.
  if (is_dead_ && job_) return finish_job();
  now_ = std::max(now_, limit);
  return {};
}

/// Nearly always the poll that is due is there first (recording fault-erase-objective); the other
/// order is in recording defect-neighbour-release-on-estop.
bool Worker::comes_before_poll(Job& job) noexcept {
  if (job.posted < poll_due_) return true;
  if (!std::exchange(job.goes_on, false) || !has_failed_) return false;
  const auto race = repair_races_++;
  return race < 32 && (late_repairs_ >> race & 1U) != 0;
}

Worker::Report Worker::finish_job() {
  if (job_->kind == Job::Kind::kEvent && !asked_.empty() && !is_dead_) {
    steps_.assign(asked_.rbegin(), asked_.rend());
    asked_.clear();
    return {};
  }
  const auto job = *std::exchange(job_, std::nullopt);
  if (job.kind == Job::Kind::kEvent) return {Report::Kind::kEventOver, job.event};
  return {job.is_awaited ? Report::Kind::kDone : Report::Kind::kNothing};
}

void Worker::die() noexcept {
  is_dead_ = true;
  step_.reset();
  steps_.clear();
  asked_.clear();
}

/// What the shipped server does not survive and any other repairs.
void Worker::give_up() {
  if (behaviour_.dies) {
    die();
  } else {
    has_failed_ = true;
  }
}

void Worker::begin(const Job& job) {
  using Kind = Step::Kind;
  job_ = job;
  switch (job.kind) {
    case Job::Kind::kPoll:
      poll_due_ = now_ + pace::kPoll;
      push(Kind::kRepair);
      return push_poll();
    case Job::Kind::kStop:
      return push_stop();
    case Job::Kind::kTakeControl:
      return push(Kind::kTakeControl);
    case Job::Kind::kReleaseControl:
      return push(Kind::kReleaseControl);
    case Job::Kind::kInitialize:
      if (!has_failed_) push(Kind::kFreshModeToInitialize);
      return;
    case Job::Kind::kUnfold:
      movement_ = Movement::kHoming;
      return push_homing(mode_.value_or(ArmMode::kError), ArmEvent::kHomeReached);
    case Job::Kind::kRetract:
      return push(Kind::kFreshModeToRetract);
    case Job::Kind::kSetMode:
      push(Kind::kModeIsSet);
      push(Kind::kModeRelease);
      return push(Kind::kSelect);
    case Job::Kind::kMove:
      return push(Kind::kWriteAxes);
    case Job::Kind::kGoTo:
      return push(Kind::kWriteTarget);
    case Job::Kind::kWait:
    case Job::Kind::kEvent:
      return;
  }
}

void Worker::then_stop() {
  for (const auto kind : {Step::Kind::kErase, Step::Kind::kZeroAxes, Step::Kind::kRelease}) {
    asked_.push_back({kind, 0});
  }
}

void Worker::then_go_to(const Pose& target) {
  job_->target = target;
  asked_.push_back({Step::Kind::kWriteTarget, 0});
}

void Worker::then_release_control() { asked_.push_back({Step::Kind::kReleaseControl, 0}); }

void Worker::push_stop() {
  push(Step::Kind::kRelease);
  push(Step::Kind::kZeroAxes);
  push(Step::Kind::kErase);
}

void Worker::push_poll() {
  push(Step::Kind::kReadVelocities);
  push(Step::Kind::kReadCurrents);
  push(Step::Kind::kReadMode);
  push(Step::Kind::kReadPose);
}

std::optional<ArmCall> Worker::call_of(Step step) const noexcept {
  switch (step.kind) {
    case Step::Kind::kFindArm:
    case Step::Kind::kOpen:
      return ArmCall::kOpen;
    case Step::Kind::kReadPose:
      return ArmCall::kReadPosition;
    case Step::Kind::kReadMode:
    case Step::Kind::kFreshModeToInitialize:
    case Step::Kind::kFreshModeToRetract:
      return ArmCall::kReadStatus;
    case Step::Kind::kReadCurrents:
      return ArmCall::kReadCurrent;
    case Step::Kind::kReadVelocities:
      return ArmCall::kReadVelocity;
    case Step::Kind::kTakeControl:
      return ArmCall::kTakeControl;
    case Step::Kind::kReleaseControl:
      return ArmCall::kReleaseControl;
    case Step::Kind::kErase:
      return ArmCall::kErase;
    case Step::Kind::kZeroAxes:
    case Step::Kind::kWriteAxes:
      return ArmCall::kWriteAxes;
    case Step::Kind::kRelease:
    case Step::Kind::kReleaseThere:
    case Step::Kind::kModeRelease:
      return ArmCall::kReleaseStick;
    case Step::Kind::kPress:
      return ArmCall::kPressHome;
    case Step::Kind::kWriteTarget:
      return ArmCall::kWriteTarget;
    case Step::Kind::kSelect: {
      const bool is_angular = job_->mode == Mode::kAxis1to3 || job_->mode == Mode::kAxis4to6;
      return is_angular ? ArmCall::kSelectAngular : ArmCall::kSelectCartesian;
    }
    default:
      return std::nullopt;
  }
}

Duration Worker::duration(Step step) const noexcept {
  if (step.kind == Step::Kind::kPause) return milliseconds(step.value);
  const auto call = call_of(step);
  if (!call) return {};
  return call == ArmCall::kOpen ? pace::kOpen : call_time_;
}

void Worker::carry_out(Step step) {
  const auto call = call_of(step);
  if (!call) return on_local(step);
  arm_.attempt(*call) ? on_call(step) : on_failed_call(step);
}

void Worker::on_failed_call(Step step) {
  switch (step.kind) {
    case Step::Kind::kReadPose:
      return;  // a warning in the server's log
    case Step::Kind::kFindArm:
      if (++attempts_ >= kStartAttempts) {
        aborts_ = true;
        return;
      }
      push(Step::Kind::kFindArm);
      return push_pause(static_cast<std::uint16_t>(pace::kRetryAtStart / milliseconds(1)));
    case Step::Kind::kOpen:
      push(Step::Kind::kOpen);
      return push_pause(kReopenPauseMs);
    case Step::Kind::kReadVelocities:  // kinovazed.death.velocity
    case Step::Kind::kSelect:          // kinovazed.death.mode-write
      return give_up();
    case Step::Kind::kFreshModeToRetract:  // kinovazed.death.retract-read
    case Step::Kind::kModeRelease:         // kinovazed.death.mode-release
      aborts_ = behaviour_.dies;
      has_failed_ = true;
      return;
    case Step::Kind::kZeroAxes:      // kinovazed.stop.no-release
    case Step::Kind::kReleaseThere:  // kinovazed.arm.silent-stop
      steps_.pop_back();
      has_failed_ = true;
      return;
    default:
      has_failed_ = true;
  }
}

void Worker::on_call(Step step) {
  arm_.with_plant(now_, [&](auto& plant) {
    switch (step.kind) {
      case Step::Kind::kReadPose:
        return take_pose(plant.read_pose());
      case Step::Kind::kReadMode:
        return take_mode(plant.mode());
      case Step::Kind::kReadCurrents:
        return check_current(plant.current_sum());
      case Step::Kind::kFreshModeToInitialize:
        movement_ = Movement::kInitializing;
        if (plant.mode() == ArmMode::kNeverHomed) return push(Step::Kind::kPress);
        return push_homing(mode_.value_or(ArmMode::kError), ArmEvent::kInitialized);
      case Step::Kind::kFreshModeToRetract:
        return push_retracting(plant.mode());
      case Step::Kind::kTakeControl:
        has_control_ = true;
        return plant.take_control();
      case Step::Kind::kReleaseControl:
        has_control_ = false;
        return plant.release_control();
      case Step::Kind::kErase:
        push_pause(kPauseMs);
        return plant.erase();
      case Step::Kind::kZeroAxes:
        push_pause(kPauseMs);
        return plant.move_stick({});
      case Step::Kind::kRelease:
      case Step::Kind::kReleaseThere:
      case Step::Kind::kModeRelease:
        push_pause(kPauseMs);
        return plant.release_all();
      case Step::Kind::kPress:
        push_pause(kPauseMs);
        return plant.press_home();
      case Step::Kind::kWriteAxes:
        return plant.move_stick(stick_of(job_->deflection));
      case Step::Kind::kWriteTarget:
        movement_ = Movement::kToTarget;
        target_ = job_->target;
        return plant.go_to(target_);
      case Step::Kind::kSelect:
        plant.select(call_of(step) == ArmCall::kSelectAngular ? Control::kAngular
                                                              : Control::kCartesian);
        // kinovazed.mode.guard: a second change within half a second is fatal.
        if (job_->mode != Mode::kNoMode && mode_set_ &&
            now_ - *mode_set_ < behaviour_.mode_settles && behaviour_.dies) {
          die();
        }
        return;
      case Step::Kind::kFindArm:
        push(Step::Kind::kStarted);
        return push_poll();
      case Step::Kind::kOpen:
        return forget_arm();
      default:
        return;
    }
  });
}

void Worker::on_local(Step step) {
  switch (step.kind) {
    case Step::Kind::kPostEvent:
      return post({.kind = Job::Kind::kEvent, .event = static_cast<ArmEvent>(step.value)}, now_);
    case Step::Kind::kRepair:
      if (has_failed_) repair();
      return;
    case Step::Kind::kRepaired:
      for (std::uint16_t i = 0; i < step.value; ++i) push_event(ArmEvent::kReconnected);
      if (!has_control_) return;
      push_stop();
      return push(Step::Kind::kTakeControl);
    case Step::Kind::kModeIsSet:
      joystick_mode_ = job_->mode;
      if (joystick_mode_ == Mode::kNoMode) return push_event(ArmEvent::kNoModeChanged);
      mode_set_ = now_;
      is_settling_ = true;
      return;
    case Step::Kind::kStarted:
      is_started_ = true;
      poll_due_ = now_ + pace::kPoll;
      return;
    default:
      return;
  }
}

void Worker::push_homing(ArmMode mode, ArmEvent when_there) {
  switch (mode) {
    case ArmMode::kFoldedToReady:
      push(Step::Kind::kPress);
      push(Step::Kind::kRelease);
      push_pause(kLongPressMs);
      return push(Step::Kind::kPress);
    case ArmMode::kToReady:
    case ArmMode::kReadyToFolded:
    case ArmMode::kFolded:
    case ArmMode::kElsewhere:
    case ArmMode::kNeverHomed:
      return push(Step::Kind::kPress);
    case ArmMode::kError:
      has_failed_ = true;
      return;
    default:
      movement_ = Movement::kNone;
      return push_event(when_there);
  }
}

void Worker::push_retracting(ArmMode mode) {
  movement_ = Movement::kRetracting;
  switch (mode) {
    case ArmMode::kReadyToFolded:
      push(Step::Kind::kPress);
      push(Step::Kind::kRelease);
      return push(Step::Kind::kPress);
    case ArmMode::kReady:
    case ArmMode::kFoldedToReady:
      return push(Step::Kind::kPress);
    case ArmMode::kToReady:
    case ArmMode::kElsewhere:
    case ArmMode::kNeverHomed:
      movement_ = Movement::kHomingToRetract;
      return push(Step::Kind::kPress);
    case ArmMode::kError:
      has_failed_ = true;
      return;
    default:
      movement_ = Movement::kNone;
      return push_event(ArmEvent::kRetractionReached);
  }
}

void Worker::take_pose(const Pose& pose) {
  if (!is_in_workspace(pose)) return;
  const bool is_new = !has_pose_ || has_changed(pose_, pose);
  if (is_new) pose_ = pose;
  has_pose_ = true;
  if (!is_new && behaviour_.needs_change_to_reach) return;
  if (movement_ != Movement::kToTarget || !has_reached(pose_, target_, behaviour_.reach)) return;
  movement_ = Movement::kNone;
  push_event(ArmEvent::kPointReached);
  push_pause(kPauseMs);
}

void Worker::take_mode(ArmMode mode) {
  check_settling();
  if (mode_ == mode) return;
  mode_ = mode;
  const auto arrive = [this](ArmEvent event) {
    movement_ = Movement::kNone;
    push_event(event);
    push(Step::Kind::kReleaseThere);
  };
  const bool is_ready = mode == ArmMode::kReady;
  const bool is_folded = mode == ArmMode::kFolded;
  if (is_ready && movement_ == Movement::kHoming) return arrive(ArmEvent::kHomeReached);
  if (is_ready && movement_ == Movement::kInitializing) return arrive(ArmEvent::kInitialized);
  if (is_ready && movement_ == Movement::kHomingToRetract) {
    push(Step::Kind::kFreshModeToRetract);
    return push(Step::Kind::kReleaseThere);
  }
  if (is_folded && movement_ == Movement::kRetracting) return arrive(ArmEvent::kRetractionReached);
  if (is_folded && movement_ == Movement::kInitializing) {
    // kinovazed.retract.while-initializing
    if (behaviour_.sticks_when_folded) return arrive(ArmEvent::kRetractionReached);
    push(Step::Kind::kPress);
    push(Step::Kind::kReleaseThere);
  }
}

void Worker::check_settling() {
  if (!is_settling_ || now_ - *mode_set_ < behaviour_.mode_settles) return;
  is_settling_ = false;
  push_event(ArmEvent::kModeChanged);
}

void Worker::check_current(float sum) {
  if (sum > kHighestCurrent) give_up();  // kinovazed.death.current
}

/// A failure inside a repair makes a repair inside a repair; each tells that it is over.
void Worker::repair() {
  const bool is_nested = !steps_.empty() && steps_.back().kind == Step::Kind::kRepaired;
  if (is_nested) {
    auto& times = steps_.back().value;
    times = static_cast<std::uint16_t>(std::min(times + 1, 99));
  } else {
    push(Step::Kind::kRepaired, 1);
  }
  push(Step::Kind::kRepair);
  push_poll();
  push(Step::Kind::kOpen);
}

void Worker::forget_arm() {
  has_failed_ = false;
  has_pose_ = false;
  mode_.reset();
  movement_ = Movement::kNone;
  joystick_mode_ = Mode::kNoMode;
  mode_set_.reset();
  is_settling_ = false;
}

Deflection Worker::bounded(Deflection deflection) const noexcept {
  // kinovazed.joystick.bounds: the limits are double, the pose is not.
  constexpr double kX = 0.8 - 0.01;
  constexpr double kY = 0.85 - 0.01;
  const double x = pose_.x;
  const double y = pose_.y;
  if ((deflection.x > 0 && x <= -kX) || (deflection.x < 0 && x >= kX)) deflection.x = 0;
  if ((deflection.y > 0 && y <= -kY) || (deflection.y < 0 && y >= kY)) deflection.y = 0;
  return deflection;
}

Stick Worker::stick_of(const Deflection& deflection) const noexcept {
  const auto allowed = bounded(deflection);
  // kinovazed.joystick.int-min: the most negative number keeps its sign.
  const auto negated = [](std::int32_t value) { return value == INT32_MIN ? value : -value; };
  const std::array<float, 3> axes{
      static_cast<float>(negated(allowed.x)) * behaviour_.units_per_full,
      static_cast<float>(negated(allowed.y)) * behaviour_.units_per_full,
      static_cast<float>(allowed.z) * behaviour_.units_per_full};
  switch (joystick_mode_) {
    case Mode::kXyz:
    case Mode::kAxis1to3:
      return {.translation = axes};
    case Mode::kRotation:
    case Mode::kAxis4to6:
      return {.wrist = axes};
    case Mode::kNoMode:
      break;
  }
  return {};
}

}  // namespace armjig::kinovazed::emulation
