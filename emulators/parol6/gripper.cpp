// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/gripper.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "harness/core/bytes.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::emulation {
namespace {

constexpr std::int64_t kTicksPerSecond = 5'000;
constexpr std::int32_t kFullScale = 255;

// Encoder counts at the end stops, which are also the drive's defaults for its position map.
constexpr EncoderCounts kOpenEnd{10'329};
constexpr EncoderCounts kClosedEnd{-229};

constexpr std::int32_t kArrived = 5;        // counts from the target
constexpr std::int64_t kStandsStill = 500;  // counts/s
constexpr std::uint8_t kSetPointSize = 5;
constexpr std::uint8_t kAnswerSize = 4;

// parol6.gripper.calibration
constexpr std::uint8_t kCalibrationSpeed = 40;
constexpr std::int32_t kCalibrationCurrent = 500;
constexpr std::int32_t kCalibrationTolerance = 90;        // mA
constexpr std::int64_t kCalibrationStandsStill = 700;     // counts/s
constexpr std::int64_t kCalibrationConfirmation = 3'200;  // ticks
constexpr std::int64_t kCalibrationPause = 100;           // ticks
constexpr std::int64_t kCalibrationTimeout = 150'000;     // ticks

constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max() / 4;

/// parol6.gripper.speed-map: counts/s.
constexpr std::int64_t speed_of(std::uint8_t byte) noexcept {
  return std::int64_t{byte} * 79'960 / kFullScale + 40;
}

/// parol6.gripper.position-map, rounded toward the open end.
constexpr EncoderCounts counts_of(std::uint8_t byte, EncoderCounts open,
                                  EncoderCounts closed) noexcept {
  return open + EncoderCounts{(closed.value - open.value) * byte / kFullScale};
}

constexpr std::int64_t units_of(EncoderCounts counts) noexcept {
  return counts.value * kTicksPerSecond;
}

std::int64_t tick_at(Instant time) noexcept { return time.time_since_epoch() / Gripper::kTick; }

}  // namespace

Gripper::Gripper(const GripperOptions& options)
    : options_{options},
      position_{units_of(counts_of(options.position, kOpenEnd, kClosedEnd))},
      open_end_{kOpenEnd},
      closed_end_{kClosedEnd},
      is_calibrated_{options.is_calibrated} {}

void Gripper::receive(Instant time, const CanFrame& frame) {
  if (time < mailbox_is_free_) return;
  Exchange exchange;
  exchange.frame = frame;
  exchange.handled = std::max(time, bus_is_free_) + can_frame_time(frame.size);
  mailbox_is_free_ = exchange.handled;
  bus_is_free_ = exchange.handled + kCanPause;
  const bool is_for_us = can_node(frame.id) == options_.node;
  if (is_for_us && can_command(frame.id) == GripperCan::kSetPoint) {
    exchange.answered = bus_is_free_ + can_frame_time(kAnswerSize);
    bus_is_free_ = *exchange.answered + kCanPause;
  }
  under_way_.push_back(exchange);
}

void Gripper::advance_to(Instant time) {
  while (!under_way_.empty() && under_way_.front().handled <= time) {
    auto& exchange = under_way_.front();
    if (!std::exchange(exchange.is_handled, true)) {
      run_to(exchange.handled);
      handle(exchange.frame);
      exchange.frame = answer();
    }
    if (exchange.answered) {
      if (*exchange.answered > time) break;
      sent_.push_back({*exchange.answered, exchange.frame});
    }
    under_way_.erase(under_way_.begin());
  }
  run_to(time);
}

std::optional<Instant> Gripper::next_event() const noexcept {
  const auto next = std::ranges::find_if(
      under_way_, [](const Exchange& exchange) { return exchange.answered.has_value(); });
  return next == under_way_.end() ? std::nullopt : next->answered;
}

void Gripper::touch(Instant time, const GripperPlant& plant) {
  advance_to(time - Duration{1});
  options_.plant = plant;
  alike_ = 0;
}

void Gripper::reboot(Instant time) {
  advance_to(time - Duration{1});
  Gripper fresh{options_};
  fresh.ticks_ = ticks_;
  fresh.position_ = position_;
  fresh.uses_plain_loop_ = uses_plain_loop_;
  fresh.sent_ = std::move(sent_);
  *this = std::move(fresh);
}

// What the drive makes of a frame.

void Gripper::handle(const CanFrame& request) {
  if (can_node(request.id) != options_.node) return;
  const auto command = can_command(request.id);
  const bool is_poll = command == GripperCan::kSetPoint && request.size != kSetPointSize;
  if (is_poll) return;
  alike_ = 0;
  switch (command) {
    case GripperCan::kSetPoint:
      take_set_point(request);
      break;
    case GripperCan::kCalibrate:
      begin_calibration();
      break;
    case GripperCan::kClearError:
      // parol6.gripper.clear-error: a calibration that runs is given up, the error returns at once
      // if the last set-points still ask for a stop.
      has_estop_error_ = false;
      mode_ = Mode::kIdle;
      stop_if_estop();
      break;
    case GripperCan::kAnswer:
      break;
  }
}

void Gripper::take_set_point(const CanFrame& request) noexcept {
  const auto data = std::span{request.data};
  const SetPoint wanted{.position = std::to_integer<std::uint8_t>(data[0]),
                        .speed = std::to_integer<std::uint8_t>(data[1]),
                        .current = load_i16_be(data.subspan<2, 2>()),
                        .command = std::to_integer<std::uint8_t>(data[4])};
  if (wanted != set_point_) is_at_position_ = false;
  set_point_ = wanted;
  // Our choice: a calibration goes on to its end and the set-points wait for the next ones, as the
  // idle drive behind it would have it. That is why hosts wait some seconds before they move.
  const bool follows = mode_ != Mode::kCalibrating && !has_estop_error_;
  if (follows) mode_ = Mode::kFollowing;
  stop_if_estop();
}

/// Our choice: the drive calls itself uncalibrated until it has found both ends again, forgets that
/// it stood at a position, and a drive with an error does not begin.
void Gripper::begin_calibration() noexcept {
  if (has_estop_error_) return;
  mode_ = Mode::kCalibrating;
  calibration_ = {};
  is_calibrated_ = false;
  is_at_position_ = false;
}

void Gripper::stop_if_estop() noexcept {
  if (!has(gripper_command::kEstop)) return;
  has_estop_error_ = true;
  mode_ = Mode::kIdle;
}

CanFrame Gripper::answer() const noexcept {
  CanFrame frame;
  frame.id = can_id(options_.node, GripperCan::kAnswer);
  if (has_estop_error_) frame.id |= kCanErrorBit;
  frame.size = kAnswerSize;
  frame.data[0] = std::byte{position_byte()};
  store_i16_be(std::span{frame.data}.subspan<1, 2>(), current().value);
  frame.data[3] = std::byte{status()};
  return frame;
}

EncoderCounts Gripper::position() const noexcept {
  const auto rest = position_ % kTicksPerSecond;
  const auto whole = position_ / kTicksPerSecond - (rest < 0 ? 1 : 0);
  return EncoderCounts{static_cast<std::int32_t>(whole)};
}

std::uint8_t Gripper::position_byte() const noexcept {
  const std::int64_t opened = position().value - open_end_.value;
  const auto byte = opened * kFullScale / (closed_end_.value - open_end_.value);
  return static_cast<std::uint8_t>(std::clamp<std::int64_t>(byte, 0, kFullScale));
}

std::uint8_t Gripper::status() const noexcept {
  namespace bit = gripper_status;
  unsigned status = 0;
  if (has(gripper_command::kActivate)) status |= bit::kActivated;
  if (has(gripper_command::kGoTo)) status |= bit::kGoTo;
  const auto code = static_cast<unsigned>(object());
  if ((code & 1U) != 0) status |= bit::kObjectLow;
  if ((code & 2U) != 0) status |= bit::kObjectHigh;
  if (has_estop_error_) status |= bit::kEstopError;
  if (is_calibrated_) status |= bit::kCalibrated;
  return static_cast<std::uint8_t>(status);
}

Gripper::Object Gripper::object() const noexcept {
  if (is_at_position_) return Object::kAtPosition;
  if (mode_ != Mode::kFollowing) return Object::kNone;  // our choice: the ends are no objects
  constexpr auto kStill = kStandsStill * std::int64_t{kVelocitySamples};
  if (std::abs(sum_of_steps_) > kStill) return Object::kNone;
  const bool is_forced = 10 * std::abs(current_) > 8 * std::abs(std::int32_t{set_point_.current});
  if (!is_forced) return Object::kNone;
  return current_ > 0 ? Object::kOpening : Object::kClosing;
}

bool Gripper::has(std::uint8_t command) const noexcept {
  return (set_point_.command & command) != 0;
}

// The 5 kHz interrupt.

void Gripper::run_to(Instant time) {
  const auto last = tick_at(time);
  while (ticks_ < last) {
    const auto times = uses_plain_loop_ ? 0 : std::min(repetitions(), last - ticks_);
    if (times > 0) {
      repeat_tick(times);
    } else {
      tick();
    }
  }
}

void Gripper::tick() noexcept {
  ++ticks_;
  const auto wanted = effort();
  auto motion = wanted ? motion_of(*wanted) : Motion{};
  if (wanted && wanted->until_goal - std::abs(motion.step) < units_of(EncoderCounts{kArrived})) {
    // The position loop closes what is left, and holds without load.
    motion = {.step = wanted->direction * std::min(wanted->until_goal, room(wanted->direction))};
    is_at_position_ = true;
  }
  const bool is_alike = motion.step == last_step() && motion.current == current_;
  alike_ = is_alike ? std::min(alike_ + 1, kVelocitySamples) : 1;
  position_ += motion.step;
  current_ = motion.current;
  sum_of_steps_ += motion.step - steps_[oldest_step_];
  steps_[oldest_step_] = motion.step;
  oldest_step_ = (oldest_step_ + 1) % kVelocitySamples;
  if (mode_ == Mode::kCalibrating) calibration_tick();
}

void Gripper::calibration_tick() noexcept {
  ++calibration_.elapsed;
  if (calibration_.elapsed >= kCalibrationTimeout) {
    mode_ = Mode::kIdle;
    return;
  }
  if (calibration_.phase == Phase::kPausing) {
    if (++calibration_.paused == kCalibrationPause) calibration_.phase = Phase::kClosing;
    return;
  }
  calibration_.stalled = is_stalled() ? calibration_.stalled + 1 : 0;
  if (calibration_.stalled < kCalibrationConfirmation) return;
  calibration_.stalled = 0;
  if (calibration_.phase == Phase::kOpening) {
    calibration_.open_end = position();
    calibration_.phase = Phase::kPausing;
  } else {
    end_calibration(position());
  }
}

/// The ends are where the fingers stalled, so something between them spoils the map. Our choice: a
/// drive that did not move at all has not been calibrated.
void Gripper::end_calibration(EncoderCounts closed_end) noexcept {
  mode_ = Mode::kIdle;
  if (closed_end == calibration_.open_end) return;
  open_end_ = calibration_.open_end;
  closed_end_ = closed_end;
  is_calibrated_ = true;
}

/// How many of the next interrupts will do what the last one did.
std::int64_t Gripper::repetitions() const noexcept {
  if (alike_ < kVelocitySamples) return 0;
  const auto wanted = effort();
  const auto next = wanted ? motion_of(*wanted) : Motion{};
  if (next.step != last_step() || next.current != current_) return 0;
  auto times = kFar;
  if (wanted && !next.is_blocked) {
    const auto until_arrival = wanted->until_goal - units_of(EncoderCounts{kArrived});
    times = std::min((room(wanted->direction) - 1) / wanted->speed, until_arrival / wanted->speed);
  }
  if (mode_ != Mode::kCalibrating) return times;
  times = std::min(times, kCalibrationTimeout - calibration_.elapsed - 1);
  if (calibration_.phase == Phase::kPausing) {
    return std::min(times, kCalibrationPause - calibration_.paused - 1);
  }
  return is_stalled() ? std::min(times, kCalibrationConfirmation - calibration_.stalled - 1)
                      : times;
}

void Gripper::repeat_tick(std::int64_t times) noexcept {
  ticks_ += times;
  position_ += times * last_step();
  if (mode_ != Mode::kCalibrating) return;
  calibration_.elapsed += times;
  if (calibration_.phase == Phase::kPausing) {
    calibration_.paused += times;
  } else {
    calibration_.stalled = is_stalled() ? calibration_.stalled + times : 0;
  }
}

std::int64_t Gripper::last_step() const noexcept {
  return steps_[(oldest_step_ + kVelocitySamples - 1) % kVelocitySamples];
}

bool Gripper::is_stalled() const noexcept {
  constexpr auto kStill = kCalibrationStandsStill * std::int64_t{kVelocitySamples};
  return std::abs(sum_of_steps_) <= kStill &&
         std::abs(std::abs(current_) - kCalibrationCurrent) <= kCalibrationTolerance;
}

// The mechanics.

/// What the drive asks for; none if it sleeps or holds.
std::optional<Gripper::Effort> Gripper::effort() const noexcept {
  if (mode_ == Mode::kCalibrating) {
    if (calibration_.phase == Phase::kPausing) return std::nullopt;
    return Effort{.direction = calibration_.phase == Phase::kOpening ? 1 : -1,
                  .speed = speed_of(kCalibrationSpeed),
                  .until_goal = kFar,
                  .limit = kCalibrationCurrent};
  }
  const bool may_move =
      has(gripper_command::kGoTo) && has(gripper_command::kActivate) && is_calibrated_;
  if (mode_ == Mode::kIdle || !may_move || is_at_position_) return std::nullopt;
  const auto distance =
      units_of(counts_of(set_point_.position, open_end_, closed_end_)) - position_;
  // Our choice: a negative current is taken for its magnitude.
  constexpr std::int32_t kMost = std::numeric_limits<std::int16_t>::max();
  return Effort{.direction = distance > 0 ? 1 : -1,
                .speed = speed_of(set_point_.speed),
                .until_goal = std::abs(distance),
                .limit = std::min(std::abs(std::int32_t{set_point_.current}), kMost)};
}

/// Our model: no ramp and no overshoot. Less than `kFreeCurrent` does not move the fingers.
Gripper::Motion Gripper::motion_of(const Effort& effort) const noexcept {
  const auto free_way = effort.limit < kFreeCurrent.value ? 0 : room(effort.direction);
  const auto way = std::min({effort.speed, free_way, effort.until_goal});
  const bool is_blocked = way == free_way;
  const auto force = is_blocked ? effort.limit : std::int32_t{kFreeCurrent.value};
  return {.step = effort.direction * way,
          .current = effort.direction * force,
          .is_blocked = is_blocked};
}

/// How far the fingers can go in that direction.
Gripper::Units Gripper::room(std::int32_t direction) const noexcept {
  if (!options_.plant.has_end_stops) return kFar;
  const bool opens = direction > 0;
  auto end = opens ? kOpenEnd : kClosedEnd;
  if (const auto& stop = opens ? options_.plant.stop_opening : options_.plant.stop_closing) {
    const auto place = counts_of(*stop, kOpenEnd, kClosedEnd);
    end = opens ? std::min(end, place) : std::max(end, place);
  }
  return std::max(direction * (units_of(end) - position_), Units{0});
}

}  // namespace armjig::parol6::emulation
