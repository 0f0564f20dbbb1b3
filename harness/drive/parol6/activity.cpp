// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/parol6/activity.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "harness/drive/parol6/stillness.hpp"
#include "harness/wire/parol6/fields.hpp"
#include "harness/wire/parol6/joints.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::drive {
namespace {

using namespace std::chrono_literals;
using Ending = Activity::Ending;

/// Time for a frame to the board, and for telemetry back.
constexpr Duration kToShow = 100ms;
constexpr Duration kLongestHoming = 60s;
/// The gripper's own time-out is 30 s.
constexpr Duration kLongestCalibration = 35s;
/// The slowest set-point moves the fingers by one unit in a second.
constexpr Duration kFingersStall = 3s;

std::optional<Ending> done(std::string text) { return Ending{true, std::move(text)}; }
std::optional<Ending> failed(std::string text) { return Ending{false, std::move(text)}; }

double seconds(Duration duration) { return std::chrono::duration<double>{duration}.count(); }

class CommandActivity final : public Activity {
 public:
  CommandActivity(Command command, std::string_view text) : command_{command}, text_{text} {}

 private:
  std::optional<Ending> take(Drive& drive, const DriveEvent& event) override {
    const bool took_effect =
        event.kind == DriveEvent::Kind::kTookEffect && event.command == command_;
    return took_effect ? done(std::string{text_}) : Activity::take(drive, event);
  }
  std::optional<Ending> advance(Drive& /*drive*/, Instant /*now*/) override { return std::nullopt; }

  Command command_;
  std::string_view text_;  ///< a literal
};

class Homing final : public Activity {
 public:
  std::string take_news() override { return std::exchange(news_, {}); }

 private:
  std::optional<Ending> take(Drive& drive, const DriveEvent& event) override {
    if (event.kind == DriveEvent::Kind::kHomed) {
      return done(fmt::format("homed in {:.1f} s", seconds(event.time - *began_)));
    }
    auto ending = Activity::take(drive, event);
    if (event.kind == DriveEvent::Kind::kNothingMoved)
      ending = failed("homing does not go on: is the board disabled?");
    if (ending) drive.disable();
    return ending;
  }

  std::optional<Ending> advance(Drive& drive, Instant now) override {
    if (!began_) began_ = now;
    const auto& frame = *drive.telemetry();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const bool is_new = is_homed(frame, j) && (homed_ & flag(j)) == 0;
      if (is_new && has_begun_) news_ += fmt::format("{}j{}", news_.empty() ? "" : " ", j + 1);
    }
    // Before the board begins, its flags are those of an earlier homing.
    has_begun_ = has_begun_ || !is_homed(frame);
    homed_ = frame.homed;
    if (now - *began_ < kLongestHoming) return std::nullopt;
    drive.disable();
    return failed(fmt::format("home took longer than {:.0f} s: the board is disabled now",
                              seconds(kLongestHoming)));
  }

  std::optional<Instant> began_;
  std::uint8_t homed_ = 0;
  bool has_begun_ = false;
  std::string news_;
};

std::string nothing_moved(std::size_t joint) {
  return fmt::format("the board accepted it, but j{} does not move: is the board disabled?",
                     joint + 1);
}

class JointJog : public Activity {
 protected:
  explicit JointJog(std::size_t joint) noexcept : joint_{joint} {}

  [[nodiscard]] std::size_t joint() const noexcept { return joint_; }
  /// Where the joint is; the first time is the begin.
  Steps follow(const Drive& drive, Instant now) {
    const auto position = drive.telemetry()->position[joint_];
    if (!start_) {
      start_ = position;
      began_ = now;
    }
    return position;
  }
  [[nodiscard]] Steps start() const noexcept { return *start_; }
  [[nodiscard]] Instant began() const noexcept { return began_; }

 private:
  std::size_t joint_;
  std::optional<Steps> start_;
  Instant began_{};
};

class Jog final : public JointJog {
 public:
  Jog(std::size_t joint, StepsPerSecond speed)
      : JointJog{joint}, patience_{500ms + Duration{6s} / std::abs(speed.value)} {}

  [[nodiscard]] bool leaves_it_moving() const override { return true; }

 private:
  std::optional<Ending> advance(Drive& drive, Instant now) override {
    const auto position = follow(drive, now);
    if (position != start()) return done(fmt::format("j{} moves", joint() + 1));
    if (now - began() < patience_) return std::nullopt;
    drive.idle();
    return failed(nothing_moved(joint()));
  }

  Duration patience_;
};

class JogFor final : public JointJog {
 public:
  JogFor(std::size_t joint, Duration time) : JointJog{joint}, time_{time} {}

 private:
  std::optional<Ending> advance(Drive& drive, Instant now) override {
    const auto position = follow(drive, now);
    // What is asked for now leaves with the next frame.
    if (now + kFramePeriod - began() < time_) return std::nullopt;
    if (!std::exchange(is_stopped_, true)) drive.idle();
    if (stillness_.observe(now, position) < kToStand) return std::nullopt;
    const auto way = position - start();
    if (way.value == 0) return failed(nothing_moved(joint()));
    return done(fmt::format("moved {:+} steps, {}", way.value, place_of(joint(), position)));
  }

  Duration time_;
  bool is_stopped_ = false;
  Stillness<Steps> stillness_;
};

class GoTo final : public Activity {
 public:
  explicit GoTo(const Glide& glide) : glide_{glide} {}

 private:
  /// Time goes on by periods, so that a late cycle does not make a leap.
  std::optional<Ending> advance(Drive& drive, Instant /*now*/) override {
    elapsed_ += kFramePeriod;
    const auto point = glide_.at(elapsed_);
    const auto& positions = drive.telemetry()->position;
    const bool has_arrived = elapsed_ >= glide_.duration() && positions == glide_.goal();
    const bool is_too_late = elapsed_ >= glide_.duration() + kPatience;
    if (!has_arrived && !is_too_late) {
      // A latched stop has ended this activity before.
      (void)drive.go_to(point.position, point.feed);
      return std::nullopt;
    }
    drive.idle();
    return has_arrived ? done("arrived") : failed(short_of(positions));
  }

  [[nodiscard]] std::string short_of(const JointSteps& positions) const {
    std::string text = "did not arrive:";
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (positions[j] == glide_.goal()[j]) continue;
      text +=
          fmt::format(" {} instead of {} steps", place_of(j, positions[j]), glide_.goal()[j].value);
    }
    return text;
  }

  static constexpr Duration kPatience = 2s;

  Glide glide_;
  Duration elapsed_{};
};

class Stopping final : public Activity {
 public:
  explicit Stopping(std::string text) : text_{std::move(text)} {}

 private:
  // Whatever happens, the arm has to stand first.
  std::optional<Ending> take(Drive& /*drive*/, const DriveEvent& event) override {
    return event.kind == DriveEvent::Kind::kLinkSilent ? failed("nobody knows whether it stands")
                                                       : std::nullopt;
  }

  /// Idle lets a homing go on that somebody else began; disabling ends everything.
  std::optional<Ending> advance(Drive& drive, Instant now) override {
    if (!began_) began_ = now;
    const auto stood = stillness_.observe(now, drive.telemetry()->position);
    if (now - *began_ < kToShow) return std::nullopt;
    if (stood >= kToStand) return done(text_);
    if (!std::exchange(is_disabled_, true)) {
      drive.disable();
      began_ = now;
      text_ = "stopped; the board had to be disabled for that";
      return std::nullopt;
    }
    return now - *began_ < 1s ? std::nullopt : failed("it still moves: press the emergency stop");
  }

  std::string text_;
  std::optional<Instant> began_;
  bool is_disabled_ = false;
  Stillness<JointSteps> stillness_;
};

class Outputs final : public Activity {
 public:
  explicit Outputs(std::uint8_t flags) : flags_{flags} {}

 private:
  std::optional<Ending> advance(Drive& drive, Instant now) override {
    if (!began_) began_ = now;
    const auto shown = static_cast<std::uint8_t>(drive.telemetry()->io & io_flag::kOutputs);
    // The first step comes before the answer to the frame that switched.
    const bool may_be_old = now - *began_ < 2 * kFramePeriod;
    if (may_be_old || (shown != flags_ && now - *began_ < 500ms)) return std::nullopt;
    const auto text =
        fmt::format("out1 is {}, out2 is {}", (shown & io_flag::kOut1) != 0 ? "on" : "off",
                    (shown & io_flag::kOut2) != 0 ? "on" : "off");
    return shown == flags_ ? done(text) : failed("telemetry does not show it: " + text);
  }

  std::uint8_t flags_;
  std::optional<Instant> began_;
};

bool has(const GripperReport& report, std::uint8_t status) noexcept {
  return (report.status & status) != 0;
}

class GripperMove final : public Activity {
  std::optional<Ending> advance(Drive& drive, Instant now) override {
    if (!began_) began_ = now;
    const auto& report = drive.telemetry()->gripper;
    const auto stood = stillness_.observe(now, report.position);
    if (now - *began_ < kToShow) return std::nullopt;
    if (!has(report, gripper_status::kCalibrated)) {
      return failed("the gripper is not calibrated, and does not move before");
    }
    const auto object = object_of(report.status);
    if (object == GripperObject::kAtPosition) {
      return done(fmt::format("the gripper is at {}", report.position));
    }
    if (object != GripperObject::kNone) {
      return done(fmt::format("the gripper met something at {} while {}", report.position,
                              object == GripperObject::kWhileClosing ? "closing" : "opening"));
    }
    if (stood < kFingersStall) return std::nullopt;
    return failed("the gripper does not move: is it connected?");
  }

  std::optional<Instant> began_;
  Stillness<std::int16_t> stillness_;
};

class Calibration final : public Activity {
  /// What telemetry says without a gripper looks calibrated too, so something has to change. The
  /// fingers rest for 0.64 s at their ends.
  std::optional<Ending> advance(Drive& drive, Instant now) override {
    const auto& report = drive.telemetry()->gripper;
    if (!began_) {
      began_ = now;
      first_ = report.position;
    }
    const bool is_calibrated = has(report, gripper_status::kCalibrated);
    has_changed_ = has_changed_ || report.position != first_ || !is_calibrated;
    const auto stood = stillness_.observe(now, report.position);
    if (!has_changed_ && stood > kFingersStall) {
      return failed("nothing changes: is a gripper connected?");
    }
    const bool has_ended = has_changed_ && is_calibrated && stood >= 1s && now - *began_ >= 1s;
    if (has_ended) return done(fmt::format("calibrated, the gripper is at {}", report.position));
    if (now - *began_ < kLongestCalibration) return std::nullopt;
    return failed("the gripper could not calibrate itself");
  }

  std::optional<Instant> began_;
  std::int16_t first_ = 0;
  bool has_changed_ = false;
  Stillness<std::int16_t> stillness_;
};

class GripperClear final : public Activity {
  std::optional<Ending> advance(Drive& drive, Instant now) override {
    if (!began_) began_ = now;
    if (now - *began_ < kToShow) return std::nullopt;
    constexpr std::uint8_t kErrors = gripper_status::kTemperatureError |
                                     gripper_status::kTimeoutError | gripper_status::kEstopError;
    const auto errors = drive.telemetry()->gripper.status & kErrors;
    if (errors == 0) return done("the gripper has no error");
    const auto& field = *find_field(telemetry_fields(), "gripper.status");
    return failed(fmt::format("the gripper still says {}", field_text(field, errors)));
  }

  std::optional<Instant> began_;
};

class Wait final : public Activity {
 public:
  explicit Wait(Duration time) : time_{time} {}

 private:
  std::optional<Ending> advance(Drive& /*drive*/, Instant now) override {
    if (!began_) began_ = now;
    if (now + kFramePeriod - *began_ < time_) return std::nullopt;
    return done(fmt::format("waited {:g} s", seconds(time_)));
  }

  Duration time_;
  std::optional<Instant> began_;
};

template <class Kind, class... Arguments>
Result<std::unique_ptr<Activity>> activity(const Result<void>& asked, Arguments&&... arguments) {
  if (!asked) return tl::unexpected{asked.error()};
  return std::make_unique<Kind>(std::forward<Arguments>(arguments)...);
}

JointSpeeds only(std::size_t joint, StepsPerSecond speed) noexcept {
  JointSpeeds speeds{};
  speeds[joint] = speed;
  return speeds;
}

/// With set-points of zero, which the board takes for sent but does not send.
void tell_gripper(Drive& drive, std::uint8_t mode) noexcept {
  GripperSetPoint nothing;
  nothing.mode = mode;
  drive.set_gripper(nothing);
}

}  // namespace

std::optional<Ending> Activity::step(Drive& drive, Instant now,
                                     std::span<const DriveEvent> events) {
  for (const auto& event : events) {
    if (auto ending = take(drive, event)) return ending;
  }
  return drive.telemetry() ? advance(drive, now) : std::nullopt;
}

std::optional<Ending> Activity::take(Drive& drive, const DriveEvent& event) {
  using Kind = DriveEvent::Kind;
  switch (event.kind) {
    case Kind::kEstopPressed:
      return failed("the emergency stop was pressed");
    case Kind::kLinkSilent:
      drive.idle();
      return failed("no telemetry for half a second");
    case Kind::kNoEffect:
      return failed(fmt::format("the board does not echo {}", name_of(event.command)));
    case Kind::kNothingMoved:
      drive.idle();
      return failed(nothing_moved(event.joint.value_or(0)));
    case Kind::kEstopReleased:
    case Kind::kLinkBack:
    case Kind::kTookEffect:
    case Kind::kStillMoves:
    case Kind::kHomed:
      break;
  }
  return std::nullopt;
}

Result<std::unique_ptr<Activity>> begin_command(Drive& drive, Command command) {
  if (command == Command::kEnable) {
    return activity<CommandActivity>(drive.enable(), command, "enabled");
  }
  if (command == Command::kClearError) {
    return activity<CommandActivity>(drive.clear_error(), command, "error cleared");
  }
  drive.disable();
  return std::make_unique<CommandActivity>(Command::kDisable, "disabled");
}

Result<std::unique_ptr<Activity>> begin_home(Drive& drive) {
  return activity<Homing>(drive.home());
}

Result<std::unique_ptr<Activity>> begin_jog(Drive& drive, std::size_t joint, StepsPerSecond speed) {
  return activity<Jog>(drive.jog(only(joint, speed)), joint, speed);
}

Result<std::unique_ptr<Activity>> begin_jog_for(Drive& drive, std::size_t joint,
                                                StepsPerSecond speed, Duration time) {
  return activity<JogFor>(drive.jog(only(joint, speed)), joint, time);
}

Result<std::unique_ptr<Activity>> begin_go_to(Drive& drive, const JointSteps& goal,
                                              const JointSpeeds& fastest) {
  const auto& start = drive.telemetry()->position;
  return activity<GoTo>(drive.go_to(start, {}), Glide{start, goal, fastest});
}

std::unique_ptr<Activity> begin_stop(Drive& drive) {
  if (!drive.is_homing()) {
    drive.idle();
    return std::make_unique<Stopping>("stopped");
  }
  drive.disable();
  return std::make_unique<Stopping>(
      "stopped; the board is disabled, for homing ends in no other way");
}

std::unique_ptr<Activity> begin_outputs(Drive& drive, std::uint8_t flags) {
  drive.set_outputs(flags);
  return std::make_unique<Outputs>(flags);
}

std::unique_ptr<Activity> begin_gripper_move(Drive& drive, const GripperSetPoint& set_point) {
  drive.set_gripper(set_point);
  return std::make_unique<GripperMove>();
}

std::unique_ptr<Activity> begin_gripper_calibration(Drive& drive) {
  tell_gripper(drive, gripper_mode::kCalibrate);
  return std::make_unique<Calibration>();
}

std::unique_ptr<Activity> begin_gripper_clear(Drive& drive) {
  tell_gripper(drive, gripper_mode::kClearError);
  return std::make_unique<GripperClear>();
}

std::unique_ptr<Activity> begin_wait(Duration time) { return std::make_unique<Wait>(time); }

std::string place_of(std::size_t joint, Steps position) {
  return fmt::format("j{} {} steps ({:.4f} deg)", joint + 1, position.value,
                     kJoints[joint].angle(position).value);
}

}  // namespace armjig::parol6::drive
