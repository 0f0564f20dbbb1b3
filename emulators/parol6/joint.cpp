// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/joint.hpp"

namespace armjig::parol6::emulation {
namespace {

/// The axis follows the counter for as long as this lives.
class FollowCounter {
 public:
  explicit FollowCounter(Joint& joint) noexcept : joint_{joint}, before_{joint.position()} {}
  FollowCounter(const FollowCounter&) = delete;
  FollowCounter& operator=(const FollowCounter&) = delete;
  ~FollowCounter() {
    joint_.axis.pulse(
        static_cast<std::int32_t>(static_cast<std::uint32_t>(joint_.position().value) -
                                  static_cast<std::uint32_t>(before_.value)));
  }

 private:
  Joint& joint_;
  Steps before_;
};

std::int64_t coast_seek(Joint& joint, const PassSpan& span) noexcept {
  // The switch is read before the step of the same pass, so the step that presses it is noticed one
  // pass later.
  const auto steps = joint.axis.steps_until(joint.pressed_level, joint.stepper.direction());
  if (steps == 0) return span.first;
  if (steps == Axis::kNever) {
    joint.stepper.coast_speed(span);
    return kNoPass;
  }
  auto until_press = span;
  const auto pressing = Stepper{joint.stepper}.coast_speed(until_press, std::int64_t{steps} - 1);
  if (pressing == kNoPass) {
    joint.stepper.coast_speed(span);
    return kNoPass;
  }
  until_press.last = pressing;
  joint.stepper.coast_speed(until_press);
  const auto noticing = pressing + span.period;
  return noticing <= span.last ? noticing : kNoPass;
}

}  // namespace

void Joint::run_speed(Micros now) noexcept {
  note(Motion::kSpeed);
  const FollowCounter follow{*this};
  stepper.run_speed(now);
}

void Joint::seek(Micros now) noexcept {
  note(Motion::kSeek);
  const FollowCounter follow{*this};
  stepper.run_speed(now);
}

void Joint::run_to_position(Micros now) noexcept {
  note(Motion::kToPosition);
  const FollowCounter follow{*this};
  stepper.run_speed_to_position(now);
}

void Joint::run(Micros now) noexcept {
  note(Motion::kRamp);
  const FollowCounter follow{*this};
  stepper.run(now);
}

void Joint::go_to(Micros now, Steps new_goal, StepsPerSecond new_feed) noexcept {
  note(Motion::kGoTo);
  goal = new_goal;
  feed = new_feed;
  stepper.set_speed(go_to_speed(position(), goal, feed));
  const FollowCounter follow{*this};
  stepper.run_speed(now);
}

std::int64_t Joint::coast(const PassSpan& span) noexcept {
  const FollowCounter follow{*this};
  switch (motion) {
    case Motion::kNone:
      return kNoPass;
    case Motion::kSpeed:
      return stepper.coast_speed(span);
    case Motion::kSeek:
      return coast_seek(*this, span);
    case Motion::kToPosition:
      return stepper.coast_to_position(span);
    case Motion::kRamp:
      return stepper.coast_ramp(span);
    case Motion::kGoTo:
      stepper.coast_go_to(span, goal, feed);
      return kNoPass;
    case Motion::kSeveral:
      break;
  }
  return span.first;
}

}  // namespace armjig::parol6::emulation
