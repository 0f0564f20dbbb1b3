// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "harness/core/quantity.hpp"
#include "harness/drive/morap/master.hpp"
#include "harness/wire/morap/message.hpp"
#include "harness/wire/morap/pen.hpp"

namespace armjig::morap::drive {

// In the single precision of the wire.
using Angle = Quantity<unit::Radians, float>;
using Speed = Quantity<unit::RadiansPerSecond, float>;
using Voltage = Quantity<unit::Volts, float>;
using Current = Quantity<unit::Amperes, float>;
using Torque = Quantity<unit::NewtonMetres, float>;

/// What was read. If `code` is not `kOk`, the value is what the vendor's library answers then: 0
/// for a number, 255 for a status.
template <class T>
struct Reading {
  BusCode code{};
  T value{};
};

/// How programming or tuning ended.
enum class ProgramOutcome : std::uint8_t {
  kDone,       ///< accepted, active and read back byte for byte
  kBusFailed,  ///< `ProgramResult::code` says how
  kUnsafe,     ///< nothing was sent: `is_safe` says no
  kNotReset,   ///< the programming status could not be brought to "nothing"
  kRefused,    ///< by the node
  kNotActive,  ///< accepted, but what is read back is something else
};

[[nodiscard]] std::string_view describe(ProgramOutcome outcome) noexcept;

/// Whether a node may run a set: counts are 1 to 4, the rate is 1 to 1500 Hz, all else is finite.
[[nodiscard]] bool is_safe(const ControllerSet& set) noexcept;

/// Its name on command lines: `pd`, `pid` or `pi`.
[[nodiscard]] std::optional<TuneKind> tune_kind(std::string_view name) noexcept;

/// Why the shipped node refuses a request; empty if it does not.
[[nodiscard]] std::string refusal_of(const TuneRequest& request);

struct ProgramResult {
  ProgramOutcome outcome{};
  BusCode code{};
  ControllerSet active{};  ///< what was read back, after `kDone`
};

/// A motor node as its master sees it. Calls take the time of their transactions; nothing is tried
/// twice.
class Joint {
 public:
  /// The master outlives the joint.
  Joint(Master& master, BusAddress address) noexcept : master_{&master}, address_{address} {}

  [[nodiscard]] BusAddress address() const noexcept { return address_; }

  BusCode disable() { return send({CommandId::kDisable}); }
  BusCode calibrate_zero() { return send({CommandId::kCalibrateZero}); }
  BusCode calibrate(Angle angle) { return send({CommandId::kCalibrateAngle, angle.value}); }
  BusCode forget_calibration() { return send({CommandId::kCalibrationUnknown}); }
  BusCode set_position(Angle target) { return send({CommandId::kPosition, target.value}); }
  BusCode set_speed(Speed target) { return send({CommandId::kSpeed, target.value}); }
  BusCode set_voltage(Voltage volts) { return send({CommandId::kVoltage, volts.value}); }
  /// No current limit: the motor can burn.
  BusCode set_direct_voltage(Voltage volts) {
    return send({CommandId::kDirectVoltage, volts.value});
  }
  BusCode set_torque(Torque torque) { return send({CommandId::kTorque, torque.value}); }
  /// The shipped firmware does nothing; which of the two is "on" the sources disagree about.
  BusCode brake_14() { return send({CommandId::kBrake14}); }
  BusCode brake_15() { return send({CommandId::kBrake15}); }
  BusCode load_default_controllers() { return send({CommandId::kDefaultControllers}); }
  /// Any command, for what has no call of its own.
  BusCode send(const Command& command);

  [[nodiscard]] Reading<Angle> angle() { return number<Angle>(CommandId::kReadAngle); }
  [[nodiscard]] Reading<Angle> position_reference() {
    return number<Angle>(CommandId::kReadPositionReference);
  }
  [[nodiscard]] Reading<Speed> speed_reference() {
    return number<Speed>(CommandId::kReadSpeedReference);
  }
  [[nodiscard]] Reading<Voltage> voltage() { return number<Voltage>(CommandId::kReadVoltage); }
  /// Its magnitude.
  [[nodiscard]] Reading<Current> current() { return number<Current>(CommandId::kReadCurrent); }
  [[nodiscard]] Reading<MotorStatus> status() {
    return code_byte<MotorStatus>(CommandId::kReadMotorStatus);
  }
  [[nodiscard]] Reading<ProgrammingStatus> programming_status() {
    return code_byte<ProgrammingStatus>(CommandId::kReadProgrammingStatus);
  }
  /// Seven bits.
  [[nodiscard]] Reading<std::uint8_t> own_address() {
    return code_byte<std::uint8_t>(CommandId::kReadAddress);
  }
  /// The set with its checksum as it was read; empty if that failed.
  [[nodiscard]] Reading<SetBytes> controller_set(ControllerKind kind);

  /// Brings a set into the node: loads the defaults of *both* controllers, so that the sticky
  /// status is known, sends the set, and verifies it by status and read-back. Disable the motor
  /// first.
  [[nodiscard]] ProgramResult program(const ControllerSet& set);
  /// The same with a set that the node computes.
  [[nodiscard]] ProgramResult tune(const TuneRequest& request);

 private:
  template <class T>
  Reading<T> number(CommandId selector) {
    FloatBytes bytes{};
    const auto code = read(selector, bytes);
    return {code, T{code == BusCode::kOk ? decode_float(bytes) : 0.0F}};
  }
  template <class T>
  Reading<T> code_byte(CommandId selector) {
    std::array<std::byte, 1> byte{};
    const auto code = read(selector, byte);
    return {code, code == BusCode::kOk ? T{std::to_integer<std::uint8_t>(byte[0])} : T{255}};
  }
  /// Chooses, stops, reads. Not read if the choice failed.
  BusCode read(CommandId selector, std::span<std::byte> out);
  ProgramResult program_verified(const Command& command, ControllerKind kind);

  Master* master_;
  BusAddress address_;
};

/// The pen. It needs `pen::kPause` between commands, and hangs on bytes that a command does not
/// need.
class PenDrive {
 public:
  explicit PenDrive(Master& master) noexcept : master_{&master} {}

  BusCode deploy() { return send({pen::CommandId::kDeploy}); }
  BusCode retract() { return send({pen::CommandId::kRetract}); }
  /// 0 retracted to 255 deployed. Boards with the older library retract instead.
  BusCode set_position(std::uint8_t position) {
    return send({pen::CommandId::kSetPosition, position});
  }

 private:
  BusCode send(const pen::Command& command) {
    return master_->transmit({pen::kAddress}, pen::encode(command));
  }

  Master* master_;
};

}  // namespace armjig::morap::drive
