// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/board.hpp"

#include <algorithm>
#include <ratio>

#include "harness/wire/parol6/joint_bounds.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::emulation {
namespace {

constexpr std::array<StepsPerSecond2, kJointCount> kPowerUpAcceleration{
    StepsPerSecond2{1000}, StepsPerSecond2{1000}, StepsPerSecond2{500},
    StepsPerSecond2{500},  StepsPerSecond2{500},  StepsPerSecond2{100}};

constexpr std::int64_t kDemoSleepUs = 2'000'000;
constexpr std::int64_t kStartUpUs = 740'000;

// Telemetry that the firmware never computes.
constexpr std::uint8_t kSpareFlags = 0x03;
constexpr std::uint8_t kTimeoutError = 100;
constexpr GripperReport kGripperAtPowerUp{.id = 0,
                                          .position = 0,
                                          .speed = 1,
                                          .current = Milliamperes{2},
                                          .status = 1,
                                          .object_detection = 1};

std::array<Joint, kJointCount> joints_at_power_up(const Plant& plant, const BoardProfile& profile,
                                                  const BoardFigures& figures) noexcept {
  std::array<Joint, kJointCount> joints;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    joints[j].axis = plant.axes[j];
    joints[j].pressed_level = figures.homing[j].pressed_level;
    joints[j].stepper.set_max_speed(profile.bounds_speeds ? to_rate(kJoints[j].max_speed)
                                                          : figures.max_speed);
    joints[j].stepper.set_acceleration(kPowerUpAcceleration[j]);
    joints[j].stepper.set_speed(StepRate{});
  }
  return joints;
}

constexpr Instant instant(std::int64_t pass) noexcept {
  return at(std::chrono::microseconds{pass});
}

}  // namespace

Board::Board(const Plant& plant, const BoardTiming& timing, const BoardProfile& profile,
             const BoardFigures& figures)
    : profile_{profile},
      figures_{figures},
      timing_{timing},
      joints_{joints_at_power_up(plant, profile, figures)},
      inputs_{plant.inputs},
      homing_{figures.homing},
      receiver_{profile},
      gripper_{kGripperAtPowerUp} {}

void Board::receive(Instant time, Bytes bytes) {
  run_before(time);
  bytes_waiting_.insert(bytes_waiting_.end(), bytes.begin(), bytes.end());
}

void Board::receive_can(Instant time, const CanFrame& frame) {
  run_before(time);
  can_waiting_.push_back(frame);
}

void Board::advance_to(Instant time) { run_passes(microseconds(time)); }

/// Runs the passes that start earlier than `time`.
void Board::run_before(Instant time) { run_passes(microseconds(time - Duration{1})); }

std::optional<Instant> Board::next_event() const noexcept {
  if (!is_waiting_for_pass()) return std::nullopt;
  return instant(next_pass_);
}

std::optional<Instant> Board::wakes_at() const noexcept {
  if (!is_asleep_) return std::nullopt;
  return instant(next_pass_);
}

bool Board::is_waiting_for_pass() const noexcept {
  return !bytes_waiting_.empty() || !can_waiting_.empty();
}

void Board::reboot(Instant time) {
  run_before(time);
  const auto now_us = microseconds(time);
  auto sent = std::move(sent_);
  const auto was_plain = uses_plain_loop_;
  *this = Board{plant(), timing_, profile_, figures_};
  sent_ = std::move(sent);
  uses_plain_loop_ = was_plain;
  start_ = next_pass_ = now_us + kStartUpUs;
}

Plant Board::plant() const noexcept {
  Plant plant;
  for (std::size_t j = 0; j < kJointCount; ++j) plant.axes[j] = joints_[j].axis;
  plant.inputs = inputs_;
  return plant;
}

void Board::set_plant(const Plant& plant) noexcept {
  for (std::size_t j = 0; j < kJointCount; ++j) joints_[j].axis = plant.axes[j];
  inputs_ = plant.inputs;
  outlook_ = Outlook::kOpen;
}

std::uint32_t Board::timer(std::int64_t pass) const noexcept {
  using TimerTicks = std::chrono::duration<std::int64_t, std::ratio<1, kTicksPerSecond>>;
  const auto since_start = std::chrono::microseconds{pass - start_};
  const auto ticks =
      static_cast<std::uint64_t>(std::chrono::duration_cast<TimerTicks>(since_start).count());
  const auto mask = (std::uint64_t{1} << timing_.timer_bits) - 1;
  return static_cast<std::uint32_t>((timing_.timer_at_start.value + ticks) & mask);
}

Micros Board::clock(std::int64_t pass) const noexcept {
  return {static_cast<std::uint32_t>(pass - start_) + timing_.micros_at_start};
}

void Board::run_passes(std::int64_t last) {
  while (next_pass_ <= last) {
    if (next_pass_ > silence_ends_) watch_silence();
    const bool must_communicate = is_waiting_for_pass();
    auto pass = coast(must_communicate ? next_pass_ : std::min(last, silence_ends_));
    if (pass == kNoPass) {
      pass = next_pass_;
      if (control(pass) == Next::kSleep) {
        next_pass_ = pass + kDemoSleepUs;
        continue;
      }
    }
    if (must_communicate) communicate(pass);
    next_pass_ = pass + timing_.pass_period.count();
  }
}

/// Acts on the latched command in as many passes as repeat the last one, up to `last`. Answers the
/// last of them, `kNoPass` if there was none.
std::int64_t Board::coast(std::int64_t last) {
  if (outlook_ == Outlook::kOpen) return kNoPass;
  const auto period = std::int64_t{timing_.pass_period.count()};
  PassSpan span{.first = next_pass_,
                .last = next_pass_ + (last - next_pass_) / period * period,
                .period = static_cast<std::uint32_t>(period),
                .clock_offset = clock(0).value};
  if (outlook_ == Outlook::kStill) return span.last;
  if (outlook_ == Outlook::kSteady) {
    for (auto& joint : joints_) joint.coast(span);
    return span.last;
  }
  for (;;) {
    auto trial = joints_;
    auto earliest = kNoPass;
    for (auto& joint : trial) earliest = std::min(earliest, joint.coast(span));
    if (earliest == kNoPass) {
      joints_ = trial;
      return span.last;
    }
    if (earliest == span.first) return kNoPass;
    span.last = earliest - period;
  }
}

Board::Outlook Board::outlook() const noexcept {
  if (!is_settled_ || uses_plain_loop_) return Outlook::kOpen;
  auto outlook = Outlook::kStill;
  for (const auto& joint : joints_) {
    switch (joint.motion) {
      case Motion::kNone:
        break;
      case Motion::kSpeed:
      case Motion::kGoTo:
        if (profile_.stops_at_bounds) return Outlook::kOpen;
        outlook = std::max(outlook, Outlook::kSteady);
        break;
      case Motion::kSeek:
      case Motion::kToPosition:
      case Motion::kRamp:
        outlook = Outlook::kWatched;
        break;
      case Motion::kSeveral:
        return Outlook::kOpen;
    }
  }
  return outlook;
}

/// One pass up to where it turns to the link.
Board::Next Board::control(std::int64_t pass) {
  is_settled_ = true;
  for (auto& joint : joints_) joint.motion = Motion::kNone;
  const auto next = act(clock(pass));
  outlook_ = outlook();
  return next;
}

Board::Next Board::act(Micros now) {
  if (is_stopped_by_hand()) {
    end_homing();
    is_enabled_ = false;
  }
  if (is_silent_) return Next::kCommunicate;
  if (latched_.command != Command::kHome) is_home_served_ = false;
  switch (latched_.command) {
    case Command::kDemo:
      if (profile_.has_demo) return demo(now);
      break;
    case Command::kIdle:
      if (home_wanted_ && is_enabled_ && !home_finished_) {
        home(now);
      } else {
        idle();
      }
      demo_leg_ = DemoLeg::kWaiting;
      break;
    case Command::kEnable:
      end_homing();
      homing_.reset();
      is_enabled_ = !is_stopped_by_hand();
      break;
    case Command::kDisable:
      end_homing();
      is_enabled_ = false;
      break;
    case Command::kClearError:
      end_homing();
      homing_.reset();
      position_errors_ = 0;
      break;
    case Command::kHome:
      if (!is_enabled_ || is_home_served_) break;
      home_wanted_ = true;
      home_finished_ = false;
      home(now);
      break;
    case Command::kJog:
      if (is_enabled_) jog(now);
      break;
    case Command::kGoTo:
      if (is_enabled_) go_to(now);
      break;
  }
  return Next::kCommunicate;  // any other code: nothing steps, set speeds stay as they are
}

void Board::idle() noexcept {
  if (home_wanted_) {
    // parol6.home.idle-after: the first idle pass after homing only drops the request.
    if (home_finished_) {
      home_wanted_ = false;
      is_settled_ = false;
    }
    return;
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    joints_[j].stepper.set_speed(profile_.rests_when_idle ? StepRate{}
                                                          : to_rate(latched_.speed[j]));
  }
}

void Board::home(Micros now) noexcept {
  const auto change = homing_.pass(joints_, now);
  is_settled_ = change == Homing::Change::kNone;
  if (change != Homing::Change::kFinished) return;
  home_finished_ = true;
  is_home_served_ = profile_.homes_once && latched_.command == Command::kHome;
}

/// What the shipped board keeps of a homing that is interrupted, `Homing` knows.
void Board::end_homing() noexcept {
  const bool interrupts = home_wanted_ && !home_finished_;
  home_wanted_ = false;
  if (!interrupts || !profile_.homes_afresh) return;
  homing_.forget();
  for (auto& joint : joints_) joint.stepper.set_speed(StepRate{});
}

void Board::begin_motion() noexcept {
  end_homing();
  home_finished_ = true;
}

void Board::jog(Micros now) noexcept {
  begin_motion();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    auto& joint = joints_[j];
    const auto speed = latched_.speed[j];
    joint.stepper.set_speed(is_held_at_bound(j, speed) ? StepRate{} : to_rate(speed));
    joint.run_speed(now);
  }
}

void Board::go_to(Micros now) noexcept {
  begin_motion();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    auto& joint = joints_[j];
    const auto goal = latched_.position[j];
    const auto feed = latched_.speed[j];
    const auto speed = go_to_speed(joint.position(), goal, feed);
    if (is_held_at_bound(j, StepsPerSecond{static_cast<std::int32_t>(speed.value)})) {
      joint.stepper.set_speed(StepRate{});
    } else {
      joint.go_to(now, goal, feed);
    }
  }
}

bool Board::is_held_at_bound(std::size_t joint, StepsPerSecond speed) const noexcept {
  if (!profile_.stops_at_bounds || !are_all_homed(homing_.homed()) || speed.value == 0)
    return false;
  const auto [lower, upper] = kJointBounds[joint];
  const auto position = joints_[joint].position();
  return speed.value > 0 ? position >= upper : position <= lower;
}

bool Board::is_stopped_by_hand() const noexcept {
  return profile_.disables_at_estop && inputs_.estop == Level::kLow;
}

/// The pass comes too late for the command that is latched.
void Board::watch_silence() noexcept {
  is_silent_ = true;
  silence_ends_ = kNoPass;
  outlook_ = Outlook::kOpen;
}

/// parol6.demo: also runs while disabled. A leg that ends lets the next one begin in the same pass.
Board::Next Board::demo(Micros now) noexcept {
  if (is_asleep_) {
    is_asleep_ = false;
    demo_leg_ = DemoLeg::kBack;
  }
  if (demo_leg_ == DemoLeg::kWaiting) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      auto& stepper = joints_[j].stepper;
      stepper.set_max_speed(StepRate{figures_.demo[j].max_speed_and_acceleration});
      stepper.set_acceleration(StepsPerSecond2{figures_.demo[j].max_speed_and_acceleration});
      stepper.move_to(figures_.demo[j].out);
    }
    demo_leg_ = DemoLeg::kOut;
  }
  if (demo_leg_ == DemoLeg::kOut && !run_all(now)) {
    for (std::size_t j = 0; j < kJointCount; ++j) joints_[j].stepper.move_to(figures_.demo[j].back);
    is_asleep_ = true;
    is_settled_ = false;
    return Next::kSleep;
  }
  if (demo_leg_ == DemoLeg::kBack && !run_all(now)) {
    demo_leg_ = DemoLeg::kDone;
    is_settled_ = false;
  }
  return Next::kCommunicate;
}

/// Runs every joint on its ramp. False if all have arrived.
bool Board::run_all(Micros now) noexcept {
  for (auto& joint : joints_) joint.run(now);
  return std::ranges::any_of(joints_,
                             [](const Joint& joint) { return joint.stepper.is_running(); });
}

void Board::communicate(std::int64_t pass) {
  if (!can_waiting_.empty()) {
    take_gripper_answer(can_waiting_.front());
    can_waiting_.erase(can_waiting_.begin());
  }
  std::size_t used = 0;
  while (used < bytes_waiting_.size()) {
    const auto step = receiver_.step(Bytes{bytes_waiting_}.subspan(used));
    used += step.used;
    if (!step.body) continue;
    accept(pass, *step.body);
    if (profile_.acts_on_each_frame) break;
  }
  bytes_waiting_.erase(bytes_waiting_.begin(),
                       bytes_waiting_.begin() + static_cast<std::ptrdiff_t>(used));
}

void Board::accept(std::int64_t pass, CommandReceiver::Body body) {
  const auto timer_now = timer(pass);
  const auto interval = static_cast<std::uint16_t>(timer_now - timer_at_frame_);
  timer_at_frame_ = timer_now;
  if (!std::ranges::equal(body, latched_body_)) {
    std::ranges::copy(body, latched_body_.begin());
    latched_ = decode_command(latched_body_);
    outlook_ = Outlook::kOpen;
  }
  send_gripper_frame(pass);
  send_telemetry(pass, interval);
  if (!profile_.minds_silence) return;
  if (is_silent_) outlook_ = Outlook::kOpen;
  is_silent_ = false;
  silence_ends_ = latched_.timeout == 0 ? kNoPass : pass + std::int64_t{latched_.timeout} * 1000;
}

/// Exactly one CAN frame for each accepted serial frame. To the shipped board, what arrives
/// together with a calibration or a clear-error counts as sent although it was not
/// (parol6.gripper.forgotten-set-point).
void Board::send_gripper_frame(std::int64_t pass) {
  using namespace gripper_mode;
  const auto& wanted = latched_.gripper;
  const auto is_same = [](GripperSetPoint a, const GripperSetPoint& b) {
    a.mode = b.mode;
    return a == b;
  };
  CanFrame frame;
  if (wanted.mode == kCalibrate) {
    frame.id = can_id(wanted.id, GripperCan::kCalibrate);
  } else if (wanted.mode == kClearError) {
    frame.id = can_id(wanted.id, GripperCan::kClearError);
  } else {
    frame.id = can_id(wanted.id, GripperCan::kSetPoint);
    if (wanted.mode != kMove || !is_same(wanted, gripper_sent_)) {
      frame.size = 5;
      frame.data[0] = static_cast<std::byte>(wanted.position);
      frame.data[1] = static_cast<std::byte>(wanted.speed);
      const auto current = profile_.bounds_current
                               ? std::clamp(wanted.current, Milliamperes{0}, kMaxGripperCurrent)
                               : wanted.current;
      store_i16_be(std::span{frame.data}.subspan<2, 2>(), current.value);
      frame.data[4] = static_cast<std::byte>(wanted.command);
    }
  }
  const bool is_sent = wanted.mode != kCalibrate && wanted.mode != kClearError;
  if (is_sent || !profile_.remembers_set_points) gripper_sent_ = wanted;
  sent_.emplace_back(instant(pass), frame);
}

void Board::take_gripper_answer(const CanFrame& frame) noexcept {
  constexpr std::uint8_t kAnswerSize = 4;
  const bool is_for_us = can_command(frame.id) == GripperCan::kAnswer &&
                         frame.size == kAnswerSize && can_node(frame.id) == latched_.gripper.id;
  if (!is_for_us) return;
  const auto data = std::span{frame.data};
  gripper_.position = std::to_integer<std::int16_t>(data[0]);
  gripper_.current = Milliamperes{load_i16_be(data.subspan<1, 2>())};
  gripper_.status = std::to_integer<std::uint8_t>(data[3]);
}

void Board::send_telemetry(std::int64_t pass, std::uint16_t interval) {
  const auto level_flag = [](Level level, std::uint8_t mask) {
    return static_cast<std::uint8_t>(level == Level::kHigh ? mask : 0);
  };
  TelemetryFrame frame;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    frame.position[j] = joints_[j].position();
    frame.speed[j] = StepsPerSecond{static_cast<std::int32_t>(joints_[j].stepper.speed().value)};
  }
  frame.homed = homing_.homed() | kSpareFlags;
  frame.io = level_flag(inputs_.in1, io_flag::kIn1) | level_flag(inputs_.in2, io_flag::kIn2) |
             (latched_.in_out & io_flag::kOutputs) |
             level_flag(inputs_.estop, io_flag::kEstopReleased) | io_flag::kSpare;
  frame.temperature_error = kSpareFlags;
  if (profile_.reports_position_errors) position_errors_ |= joints_out_of_range();
  frame.position_error = position_errors_ | kSpareFlags;
  frame.timing = interval;
  frame.timeout_error = profile_.minds_silence ? std::uint8_t{is_silent_} : kTimeoutError;
  frame.echo = latched_.command;
  frame.gripper = gripper_report();
  sent_.emplace_back(instant(pass), encode(frame));
}

GripperReport Board::gripper_report() const noexcept {
  auto report = gripper_;
  if (profile_.reports_gripper) {
    report.id = latched_.gripper.id;
    report.speed = latched_.gripper.speed;
    report.object_detection = static_cast<std::uint8_t>(object_of(gripper_.status));
  }
  return report;
}

/// Counters are robot coordinates only when all joints are homed.
std::uint8_t Board::joints_out_of_range() const noexcept {
  if (!are_all_homed(homing_.homed())) return 0;
  std::uint8_t flags = 0;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto [lower, upper] = kJointBounds[j];
    const auto position = joints_[j].position();
    if (position < lower || position > upper) flags |= flag(j);
  }
  return flags;
}

}  // namespace armjig::parol6::emulation
