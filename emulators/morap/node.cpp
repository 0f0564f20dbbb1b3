// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/node.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "emulators/morap/tuner.hpp"

namespace armjig::morap::emulation {
namespace {

constexpr float kIdlePeriod = 1.0F / kIdleRateHz;  // s; by which voltage and torque modes reckon
// Of the current sense: volts at full scale, and what of the motor's current the bridge sends
// there.
constexpr double kFullScaleVolts = 3.3;
constexpr double kSenseShare = 377e-6;

bool has_count(const ControllerSet& set, auto is_it) noexcept {
  return is_it(set.d.count) || is_it(set.c.count) || is_it(set.f.count);
}

constexpr auto is_above_four = [](std::uint8_t count) { return count > kMostCoefficients; };

/// Coefficients above the counts of `set` stay as they are: recording random/mini-tune-leftover.
void write_over(ControllerSet& staging, const ControllerSet& set) noexcept {
  staging.kind = set.kind;
  staging.rate_hz = set.rate_hz;
  staging.integral = set.integral;
  for (const auto filter : {&ControllerSet::d, &ControllerSet::c, &ControllerSet::f}) {
    (staging.*filter).count = (set.*filter).count;
    std::copy_n((set.*filter).values.begin(), (set.*filter).count,
                (staging.*filter).values.begin());
  }
}

float limited(float value, float limit) noexcept {
  if (value > limit) return limit;
  return value < -limit ? -limit : value;
}

}  // namespace

Node::Node(const NodeSetup& setup)
    : setup_{setup},
      scale_{setup.eeprom.motor},
      is_on_bus_{is_usable(setup.eeprom, setup.profile)},
      next_tick_{0},
      tick_period_{0} {
  if (setup.plant) plant_.emplace(*setup.plant);
  restart(Instant{});
}

bool Node::acknowledges(std::uint8_t address) const noexcept {
  return is_on_bus_ && address == this->address();
}

void Node::start(Instant time, bool /*is_read*/) noexcept {
  run_before(cycles_at(time));
  ram_.count = 0;
  stretch_ = {};
}

bool Node::write(Instant time, std::byte byte) noexcept {
  run_before(cycles_at(time));
  stretch_ = {};
  if (ram_.count == 0) ram_.id = CommandId{std::to_integer<std::uint8_t>(byte)};
  if (is_known()) handle(byte);
  ++ram_.count;
  return true;
}

std::byte Node::read(Instant time) noexcept {
  run_before(cycles_at(time));
  const std::size_t place = ram_.count++;
  switch (find_reading(ram_.selected)->kind) {
    case ReadKind::kByte:
      return status_byte();
    case ReadKind::kControllerSet: {
      const auto& set =
          ram_.selected == CommandId::kReadPositionSet ? ram_.position_set : ram_.speed_set;
      const auto byte_of = [place](const auto& bytes) {
        return place < bytes.size() ? bytes.view()[place] : std::byte{};
      };
      return has_count(set, is_above_four) ? byte_of(read_back(set)) : byte_of(encode(set));
    }
    case ReadKind::kFloat:
      break;
  }
  if (place == 0) ram_.value = morap::encode(sample_float());
  if (place < ram_.value.size()) return ram_.value[place];
  note(Undefined::kReadPastFloat);
  return {};
}

void Node::advance_to(Instant time) noexcept { run_before(cycles_at(time) + 1); }

void Node::restart(Instant time) noexcept {
  const auto now = cycles_at(time);
  run_before(now);
  ram_ = Ram{};
  ram_.position_set = setup_.eeprom.position;
  ram_.speed_set = setup_.eeprom.speed;
  tick_period_ = tick_period(setup_.law.idle_rate_hz);
  next_tick_ = is_on_bus_ ? now + tick_period_ : kNever;
  set_encoder_count(0);
  connect_plant();
}

void Node::turn_encoder(Instant time, std::int32_t counts) noexcept {
  run_before(cycles_at(time));
  encoder_offset_ += counts;
}

void Node::set_conversion(Instant time, std::uint16_t code) noexcept {
  run_before(cycles_at(time));
  conversion_ = std::min(code, kFullScale);
}

MotorStatus Node::status() const noexcept {
  if (!ram_.is_calibrated) return MotorStatus::kNeedsCalibration;
  return ram_.mode == Mode::kDisabled ? MotorStatus::kDisabled : MotorStatus::kEnabled;
}

std::int32_t Node::encoder_count() const noexcept {
  return static_cast<std::int32_t>((plant_ ? plant_->encoder() : 0) + encoder_offset_);
}

void Node::set_encoder_count(std::int32_t count) noexcept {
  encoder_offset_ = count - (plant_ ? plant_->encoder() : 0);
}

// ---- Bytes from the bus

/// The documented profile acknowledges and ignores what its document does not list.
bool Node::is_known() const noexcept {
  if (setup_.profile.has_undocumented) return true;
  const auto* command = find_command(ram_.id);
  const auto* reading = find_reading(ram_.id);
  return (command != nullptr && command->is_documented) ||
         (reading != nullptr && reading->is_documented);
}

void Node::handle(std::byte byte) noexcept {
  using enum CommandId;
  switch (ram_.id) {
    case kDisable:
      return set_mode(Mode::kDisabled);
    case kPosition:
    case kSpeed:
    case kVoltage:
    case kDirectVoltage:
    case kTorque:
    case kCalibrateAngle:
      return handle_float(byte);
    case kBrake14:
      return set_brake(false);
    case kBrake15:
      return set_brake(true);
    case kCalibrateZero:
      set_encoder_count(0);
      ram_.is_calibrated = true;
      return;
    case kCalibrationUnknown:
      ram_.is_calibrated = false;
      return set_mode(Mode::kDisabled);
    case kProgram:
      return handle_program(byte);
    case kDefaultControllers:
      if (ram_.count != 0) return;
      ram_.programming = ProgrammingStatus::kNothing;
      return await_tick(Pending::kDefaults);
    case kTune:
      return handle_tune(byte);
    default:
      if (find_reading(ram_.id) != nullptr) ram_.selected = ram_.id;
  }
}

void Node::handle_float(std::byte byte) noexcept {
  if (ram_.count == 0) return;
  if (ram_.count > ram_.value.size()) return note(Undefined::kOverlongFloat);
  ram_.value[ram_.count - 1U] = byte;
  if (ram_.count == ram_.value.size()) apply_float(decode_float(ram_.value));
}

void Node::apply_float(float value) noexcept {
  switch (ram_.id) {
    case CommandId::kPosition:
      ram_.position = value;
      if (setup_.law.resets_with_reference) ram_.resets = true;
      return set_mode(Mode::kPosition);
    case CommandId::kSpeed:
      ram_.speed = value;
      return set_mode(Mode::kSpeed);
    case CommandId::kVoltage:
      ram_.voltage = value;
      return set_mode(Mode::kVoltage);
    case CommandId::kDirectVoltage:
      ram_.voltage = value;
      return set_mode(Mode::kDirectVoltage);
    case CommandId::kTorque:
      ram_.current = value / scale_.torque_per_amp;
      return set_mode(Mode::kTorque);
    default: {  // morap.calibrate.angle
      constexpr float kLimit = 2147483648.0F;
      const float count = value * scale_.gear_ratio / scale_.quantum;
      if (!(std::fabs(count) < kLimit)) note(Undefined::kConversion);
      set_encoder_count(scale_.count(value));
      ram_.is_calibrated = true;
    }
  }
}

void Node::handle_program(std::byte byte) noexcept {
  if (ram_.count == 0) return;
  if (ram_.count == 1) ram_.parser.begin();
  const auto verdict = ram_.parser.step(byte, ram_.staging);
  if (verdict == ParameterParser::Verdict::kGoesOn) return;
  const auto& profile = setup_.profile;
  const bool is_refused =
      (profile.refuses_other_kinds && ram_.staging.kind > ControllerKind::kSpeed) ||
      (profile.refuses_zero_rate && ram_.staging.rate_hz == 0);
  if (verdict == ParameterParser::Verdict::kRefused || is_refused) {
    ram_.programming = ProgrammingStatus::kFailure;
    return;
  }
  ram_.programming = ProgrammingStatus::kSuccess;
  await_tick(Pending::kStaged);
}

void Node::handle_tune(std::byte byte) noexcept {
  if (ram_.count >= kTuneCommandSize) return;
  ram_.tune[ram_.count] = byte;
  if (ram_.count + 1U < kTuneCommandSize) return;
  stretch_ = setup_.tune_stretch;
  const Bytes message{ram_.tune};
  const TuneRequest request{TuneKind{std::to_integer<std::uint8_t>(message[1])},
                            load_f32_le(slice<4>(message, 2)), load_f32_le(slice<4>(message, 6))};
  const auto set = tune(request, setup_.eeprom.motor, setup_.profile);
  ram_.programming = set ? ProgrammingStatus::kSuccess : ProgrammingStatus::kFailure;
  if (!set) return;
  write_over(ram_.staging, *set);
  await_tick(Pending::kStaged);
}

void Node::await_tick(Pending pending) noexcept {
  ram_.pending = pending;
  if (!setup_.law.waits_with_parameters) install_pending();
}

void Node::set_mode(Mode mode) noexcept {
  ram_.mode = mode;
  if (mode != Mode::kDisabled) set_brake(false);
  if (!setup_.law.acts_at_ticks) act();
}

/// Shorts the leads of a motor that is not driven. Takes effect at the next tick.
void Node::set_brake(bool is_on) noexcept {
  ram_.is_braked = is_on && setup_.profile.has_brake && ram_.mode == Mode::kDisabled;
}

float Node::sample_float() noexcept {
  switch (ram_.selected) {
    case CommandId::kReadPositionReference:
      return ram_.position;
    case CommandId::kReadSpeedReference:
      return ram_.speed;
    case CommandId::kReadVoltage:
      return volts_of(ram_.drive.level);
    case CommandId::kReadCurrent:
      return static_cast<float>(convert_current()) * static_cast<float>(kFullScaleVolts) /
             static_cast<float>(kFullScale) / static_cast<float>(kBelievedShuntOhm) /
             static_cast<float>(kSenseShare);
    default:
      return angle();
  }
}

std::byte Node::status_byte() const noexcept {
  switch (ram_.selected) {
    case CommandId::kReadMotorStatus:
      return static_cast<std::byte>(status());
    case CommandId::kReadProgrammingStatus:
      return static_cast<std::byte>(ram_.programming);
    default:
      return std::byte{address()};
  }
}

/// What the current sense of the bridge makes of the current through a shunt resistor.
std::uint16_t Node::convert_current() const noexcept {
  if (!plant_) return conversion_;
  const double code = std::floor(std::fabs(plant_->current()) * kSenseShare * setup_.shunt_ohm /
                                     kFullScaleVolts * kFullScale +
                                 0.5);
  return code < kFullScale ? static_cast<std::uint16_t>(code) : kFullScale;
}

// ---- Time

/// Everything before `time`, and the plant at `time` itself.
void Node::run_before(Cycles time) noexcept {
  while (next_tick_ < time) {
    if (has_idle_tick()) {
      next_tick_ += (time - 1 - next_tick_) / tick_period_ * tick_period_;
    }
    if (plant_) plant_->advance_to(next_tick_);
    tick();
    next_tick_ += tick_period_;
  }
  if (plant_) plant_->advance_to(time);
}

/// Whether a tick changes nothing, so that many can be passed over.
bool Node::has_idle_tick() const noexcept {
  const bool is_off = ram_.mode == Mode::kDisabled && ram_.last_mode == Mode::kDisabled;
  const auto bridge = ram_.is_braked ? Bridge::kShorted : Bridge::kOpen;
  return is_off && ram_.pending == Pending::kNone && !ram_.delayed && ram_.drive.bridge == bridge &&
         ram_.drive.level == kZeroVolts;
}

void Node::tick() noexcept {
  if (ram_.delayed) ram_.drive.level = *std::exchange(ram_.delayed, std::nullopt);
  const bool is_forced = ram_.pending != Pending::kNone;
  install_pending();
  if (is_forced || ram_.mode != ram_.last_mode) enter_mode();
  act();
}

void Node::install_pending() noexcept {
  const auto pending = std::exchange(ram_.pending, Pending::kNone);
  if (pending == Pending::kDefaults) {
    ram_.position_set = setup_.eeprom.position;
    ram_.speed_set = setup_.eeprom.speed;
  }
  if (pending != Pending::kStaged) return;
  if (ram_.staging.kind == ControllerKind::kPosition) ram_.position_set = ram_.staging;
  if (ram_.staging.kind == ControllerKind::kSpeed) ram_.speed_set = ram_.staging;
}

/// The rate follows the mode, even while nothing is driven.
void Node::enter_mode() noexcept {
  auto rate = setup_.law.idle_rate_hz;
  if (ram_.mode == Mode::kPosition) rate = ram_.position_set.rate_hz;
  if (ram_.mode == Mode::kSpeed) rate = ram_.speed_set.rate_hz;
  if (rate == 0) note(Undefined::kZeroRate);
  if (setup_.law.changes_rate) tick_period_ = tick_period(rate);
  const bool is_new_mode = ram_.mode != ram_.last_mode;
  if (is_new_mode ? setup_.law.resets_with_mode : setup_.law.resets_with_parameters) {
    ram_.resets = true;
  }
  ram_.last_mode = ram_.mode;
}

void Node::act() noexcept {
  const bool may_run = ram_.is_calibrated || setup_.law.runs_uncalibrated;
  if (!may_run || ram_.mode == Mode::kDisabled) {
    ram_.drive = {ram_.is_braked ? Bridge::kShorted : Bridge::kOpen, kZeroVolts};
    return connect_plant();
  }
  ram_.drive.bridge = Bridge::kDriven;
  switch (ram_.mode) {
    case Mode::kPosition:
      run_loop(ram_.position_set, ram_.position);
      break;
    case Mode::kSpeed:
      run_loop(ram_.speed_set, ram_.speed);
      break;
    case Mode::kVoltage: {
      const float speed = turned_since(ram_.voltage_mode_angle) / kIdlePeriod;
      const float limited_voltage = scale_.limit_current(ram_.voltage, speed);
      const bool is_raised = limited_voltage > ram_.voltage;
      const bool obeys =
          is_raised ? setup_.law.bounds_voltage_below : setup_.law.bounds_voltage_above;
      drive(obeys ? limited_voltage : ram_.voltage);
      break;
    }
    case Mode::kDirectVoltage:
      drive(setup_.law.limits_direct_voltage ? scale_.limit_current(ram_.voltage, 0.0F)
                                             : ram_.voltage);
      break;
    case Mode::kTorque: {
      const float turned = turned_since(ram_.torque_mode_angle);
      const float induced =
          setup_.law.compensates_motion ? scale_.back_emf * turned / kIdlePeriod : 0.0F;
      const float current =
          setup_.law.limits_torque ? limited(ram_.current, scale_.rated_current) : ram_.current;
      drive(induced + scale_.resistance * current);
      break;
    }
    case Mode::kDisabled:
      break;
  }
  connect_plant();
}

/// What a loop computes is put out one tick later.
void Node::run_loop(const ControllerSet& set, float reference) noexcept {
  if (has_count(set, [](auto count) { return count == 0; })) note(Undefined::kEmptyFilter);
  if (has_count(set, is_above_four)) note(Undefined::kCountAboveFour);
  const float now = angle();
  if (std::exchange(ram_.resets, false)) {
    ram_.loop.reset(set.kind, now, reference, setup_.law);
  }
  const auto level = rounded(ram_.loop.step(set, scale_, now, reference, setup_.law));
  if (setup_.law.delays_output) {
    ram_.delayed = level;
  } else {
    ram_.drive.level = level;
  }
}

void Node::drive(float volts) noexcept { ram_.drive.level = rounded(volts); }

Level Node::rounded(float volts) noexcept {
  if (std::isnan(volts)) note(Undefined::kConversion);
  return level_of(volts, setup_.law);
}

/// Radians since the last tick of the mode that keeps `last_angle`.
float Node::turned_since(float& last_angle) noexcept {
  const float now = angle();
  if (std::exchange(ram_.resets, false)) last_angle = now;
  return now - std::exchange(last_angle, now);
}

void Node::connect_plant() noexcept {
  if (!plant_) return;
  plant_->connect(ram_.drive.bridge, static_cast<double>(volts_of(ram_.drive.level)));
}

}  // namespace armjig::morap::emulation
