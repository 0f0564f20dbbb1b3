// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/worker.hpp"

#include <algorithm>
#include <utility>

namespace armjig::kinovazed::emulation {
namespace {

constexpr int kStartAttempts = 120;
constexpr float kHighestCurrent = 4.5F;  // ampere, all joints together

constexpr bool is_angular(Mode chosen) noexcept {
  return chosen == Mode::kAxis1to3 || chosen == Mode::kAxis4to6;
}

}  // namespace

struct Worker::Row {
  std::optional<ArmCall> call;
  void (Worker::*done)();
  void (Worker::*failed)();  ///< nothing but a call does
  std::optional<Duration> time{};
};

/// A step's call to the arm, what follows if it works and if it fails, and its time if that is not
/// the call's. Nothing interrupts a step, nor what is planned behind it: a command that ends a
/// motion posts jobs of its own. Only the end of the thread drops what is still to come (`die`).
struct Worker::Steps {
  using W = Worker;
  using Call = ArmCall;

  // step, call to the arm, what follows if it works and if it fails, its time
  static constexpr Row kFindArm{Call::kOpen, &W::begin_to_poll, &W::search_again, pace::kOpen};
  static constexpr Row kPauseBeforeSearch{{}, &W::go_on, {}, pace::kRetryAtStart};
  static constexpr Row kStarted{{}, &W::note_start, {}};
  // The poll. A pose that cannot be read is a warning in the server's log.
  static constexpr Row kReadPose{Call::kReadPosition, &W::take_pose, &W::go_on};
  static constexpr Row kReadMode{Call::kReadStatus, &W::take_mode, &W::fail};
  static constexpr Row kReadCurrents{Call::kReadCurrent, &W::take_current, &W::fail};
  // kinovazed.death.velocity
  static constexpr Row kReadVelocities{Call::kReadVelocity, &W::go_on, &W::give_up};
  static constexpr Row kRepair{{}, &W::repair, {}};
  static constexpr Row kOpen{Call::kOpen, &W::forget_arm, &W::open_again, pace::kOpen};
  static constexpr Row kPauseBeforeOpening{{}, &W::go_on, {}, pace::kReopen};
  static constexpr Row kRepaired{{}, &W::tell_of_repairs, {}};
  // What jobs are made of.
  static constexpr Row kTakeControl{Call::kTakeControl, &W::note_control, &W::fail};
  static constexpr Row kReleaseControl{Call::kReleaseControl, &W::note_no_control, &W::fail};
  static constexpr Row kErase{Call::kErase, &W::pause, &W::fail};
  // kinovazed.stop.no-release
  static constexpr Row kZeroAxes{Call::kWriteAxes, &W::pause, &W::fail_without_next};
  static constexpr Row kRelease{Call::kReleaseStick, &W::pause, &W::fail};
  // kinovazed.arm.silent-stop
  static constexpr Row kReleaseThere{Call::kReleaseStick, &W::pause, &W::fail_without_next};
  static constexpr Row kPress{Call::kPressHome, &W::pause, &W::fail};
  static constexpr Row kPause{{}, &W::go_on, {}, pace::kPause};
  static constexpr Row kLongPress{{}, &W::go_on, {}, pace::kLongPress};
  static constexpr Row kFreshModeToInitialize{Call::kReadStatus, &W::initialize, &W::fail};
  // kinovazed.death.retract-read
  static constexpr Row kFreshModeToRetract{Call::kReadStatus, &W::retract, &W::fail_or_abort};
  // kinovazed.death.mode-write, kinovazed.death.mode-release
  static constexpr Row kSelectCartesian{Call::kSelectCartesian, &W::guard_mode, &W::give_up};
  static constexpr Row kSelectAngular{Call::kSelectAngular, &W::guard_mode, &W::give_up};
  static constexpr Row kModeRelease{Call::kReleaseStick, &W::pause, &W::fail_or_abort};
  static constexpr Row kModeIsSet{{}, &W::note_mode, {}};
  static constexpr Row kWriteAxes{Call::kWriteAxes, &W::go_on, &W::fail};
  static constexpr Row kWriteTarget{Call::kWriteTarget, &W::note_target, &W::fail};
  static constexpr Row kPostEvent{{}, &W::post_event, {}};

  static constexpr std::initializer_list<Step> kStop{kErase, kZeroAxes, kRelease};
};

void Worker::start(Instant now) {
  now_ = now;
  next({Steps::kFindArm});
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
      const auto& row = *step_->row;
      step_ends_ = now_ + row.time.value_or(row.call ? call_time_ : Duration{});
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
void Worker::give_up() noexcept { behaviour_.dies ? die() : fail(); }

void Worker::fail_or_abort() noexcept {
  aborts_ = behaviour_.dies;
  fail();
}

void Worker::fail_without_next() {
  steps_.pop_back();
  fail();
}

void Worker::begin(const Job& job) {
  using S = Steps;
  job_ = job;
  data_.stick = {};
  data_.target = job.target;
  switch (job.kind) {
    case Job::Kind::kPoll:
      poll_due_ = now_ + pace::kPoll;
      return poll_before(S::kRepair);
    case Job::Kind::kStop:
      return next(S::kStop);
    case Job::Kind::kTakeControl:
      return next({S::kTakeControl});
    case Job::Kind::kReleaseControl:
      return next({S::kReleaseControl});
    case Job::Kind::kInitialize:
      if (!has_failed_) next({S::kFreshModeToInitialize});
      return;
    case Job::Kind::kUnfold:
      movement_ = Movement::kHoming;
      return home(ArmEvent::kHomeReached);
    case Job::Kind::kRetract:
      return next({S::kFreshModeToRetract});
    case Job::Kind::kSetMode:
      return next({is_angular(job.mode) ? S::kSelectAngular : S::kSelectCartesian, S::kModeRelease,
                   S::kModeIsSet});
    case Job::Kind::kMove:
      data_.stick = stick_of(job.deflection);
      return next({S::kWriteAxes});
    case Job::Kind::kGoTo:
      return next({S::kWriteTarget});
    case Job::Kind::kWait:
    case Job::Kind::kEvent:
      return;
  }
}

void Worker::then_stop() { asked_.insert(asked_.end(), Steps::kStop); }

void Worker::then_go_to(const Pose& target) {
  data_.target = target;
  asked_.emplace_back(Steps::kWriteTarget);
}

void Worker::then_release_control() { asked_.emplace_back(Steps::kReleaseControl); }

void Worker::carry_out(Step step) {
  const auto& row = *step.row;
  value_ = step.value;
  const bool works = !row.call || arm_.call(now_, *row.call, data_);
  (this->*(works ? row.done : row.failed))();
}

void Worker::pause() { next({Steps::kPause}); }

void Worker::open_again() { next({Steps::kPauseBeforeOpening, Steps::kOpen}); }

void Worker::begin_to_poll() { poll_before(Steps::kStarted); }

Worker::Step Worker::tell(ArmEvent event) noexcept {
  return {Steps::kPostEvent, static_cast<std::uint16_t>(event)};
}

void Worker::post_event() {
  post({.kind = Job::Kind::kEvent, .event = static_cast<ArmEvent>(value_)}, now_);
}

void Worker::poll_before(Step step) {
  using S = Steps;
  next({S::kReadPose, S::kReadMode, S::kReadCurrents, S::kReadVelocities, step});
}

void Worker::search_again() {
  aborts_ = ++attempts_ >= kStartAttempts;
  if (!aborts_) next({Steps::kPauseBeforeSearch, Steps::kFindArm});
}

void Worker::note_start() noexcept {
  is_started_ = true;
  poll_due_ = now_ + pace::kPoll;
}

void Worker::initialize() {
  movement_ = Movement::kInitializing;
  if (data_.mode == ArmMode::kNeverHomed) return next({Steps::kPress});
  home(ArmEvent::kInitialized);
}

/// From the mode of the last poll.
void Worker::home(ArmEvent when_there) {
  using S = Steps;
  switch (mode_.value_or(ArmMode::kError)) {
    case ArmMode::kFoldedToReady:  // the arm overlooks a short press
      return next({S::kPress, S::kLongPress, S::kRelease, S::kPress});
    case ArmMode::kToReady:
    case ArmMode::kReadyToFolded:
    case ArmMode::kFolded:
    case ArmMode::kElsewhere:
    case ArmMode::kNeverHomed:
      return next({S::kPress});
    case ArmMode::kError:
      has_failed_ = true;
      return;
    default:
      movement_ = Movement::kNone;
      return next({tell(when_there)});
  }
}

void Worker::retract() {
  using S = Steps;
  movement_ = Movement::kRetracting;
  switch (data_.mode) {
    case ArmMode::kReadyToFolded:
      return next({S::kPress, S::kRelease, S::kPress});
    case ArmMode::kReady:
    case ArmMode::kFoldedToReady:
      return next({S::kPress});
    case ArmMode::kToReady:
    case ArmMode::kElsewhere:
    case ArmMode::kNeverHomed:
      movement_ = Movement::kHomingToRetract;
      return next({S::kPress});
    case ArmMode::kError:
      has_failed_ = true;
      return;
    default:
      movement_ = Movement::kNone;
      return next({tell(ArmEvent::kRetractionReached)});
  }
}

void Worker::take_pose() {
  if (!is_in_workspace(data_.pose)) return;
  const bool is_new = !has_pose_ || has_changed(pose_, data_.pose);
  if (is_new) pose_ = data_.pose;
  has_pose_ = true;
  if (!is_new && behaviour_.needs_change_to_reach) return;
  if (movement_ != Movement::kToTarget || !has_reached(pose_, target_, behaviour_.reach)) return;
  movement_ = Movement::kNone;
  next({Steps::kPause, tell(ArmEvent::kPointReached)});
}

void Worker::take_mode() {
  using S = Steps;
  check_settling();
  const auto mode = data_.mode;
  if (mode_ == mode) return;
  mode_ = mode;
  const auto arrive = [this](ArmEvent event) {
    movement_ = Movement::kNone;
    next({S::kReleaseThere, tell(event)});
  };
  const bool is_ready = mode == ArmMode::kReady;
  const bool is_folded = mode == ArmMode::kFolded;
  if (is_ready && movement_ == Movement::kHoming) return arrive(ArmEvent::kHomeReached);
  if (is_ready && movement_ == Movement::kInitializing) return arrive(ArmEvent::kInitialized);
  if (is_ready && movement_ == Movement::kHomingToRetract) {
    return next({S::kReleaseThere, S::kFreshModeToRetract});
  }
  if (is_folded && movement_ == Movement::kRetracting) return arrive(ArmEvent::kRetractionReached);
  if (is_folded && movement_ == Movement::kInitializing) {
    // kinovazed.retract.while-initializing
    if (behaviour_.sticks_when_folded) return arrive(ArmEvent::kRetractionReached);
    next({S::kReleaseThere, S::kPress});
  }
}

void Worker::check_settling() {
  if (!is_settling_ || now_ - *mode_set_ < behaviour_.mode_settles) return;
  is_settling_ = false;
  next({tell(ArmEvent::kModeChanged)});
}

/// kinovazed.mode.guard: a second change within half a second is fatal.
void Worker::guard_mode() noexcept {
  const bool is_too_soon = mode_set_ && now_ - *mode_set_ < behaviour_.mode_settles;
  if (is_too_soon && job_->mode != Mode::kNoMode && behaviour_.dies) die();
}

void Worker::note_mode() {
  joystick_mode_ = job_->mode;
  if (joystick_mode_ == Mode::kNoMode) return next({tell(ArmEvent::kNoModeChanged)});
  mode_set_ = now_;
  is_settling_ = true;
}

void Worker::take_current() noexcept {
  if (data_.current_sum > kHighestCurrent) give_up();  // kinovazed.death.current
}

/// A failure inside a repair makes a repair inside a repair; each tells that it is over.
void Worker::repair() {
  using S = Steps;
  if (!has_failed_) return;
  if (steps_.empty() || steps_.back().row != &S::kRepaired) next({{S::kRepaired, 0}});
  auto& times = steps_.back().value;
  times = static_cast<std::uint16_t>(std::min(times + 1, 99));
  poll_before(S::kRepair);
  next({S::kOpen});
}

void Worker::note_target() noexcept {
  movement_ = Movement::kToTarget;
  target_ = data_.target;
}

void Worker::tell_of_repairs() {
  for (int i = 0; i < value_; ++i) next({tell(ArmEvent::kReconnected)});
  if (!has_control_) return;
  next(Steps::kStop);
  next({Steps::kTakeControl});
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
  constexpr double kX = workspace::kX - 0.01;
  constexpr double kY = workspace::kY - 0.01;
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
