// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

/// How far the shaft turns in a time, rad.
float turned(NodeBench& node, Duration time) {
  const float before = node.number(kReadAngle);
  node.pause(time);
  return node.number(kReadAngle) - before;
}

template <int sign>
void sense(NodeBench& node) {
  node.send(kVoltage, static_cast<float>(sign) * 1.5F);
  const float angle = turned(node, 300ms);
  node.expect_true(static_cast<float>(sign) * angle > 0.01F, "the shaft to follow the voltage",
                   fmt::format("a turn of {} rad", angle));
  node.send(kDisable);
}

/// An angle, and between which instants it was read.
struct Reading {
  double angle;
  Instant earliest;
  Instant latest;
};

Reading read_angle(NodeBench& node) {
  const auto earliest = node.now();
  const double angle{node.number(kReadAngle)};
  return {angle, earliest, node.now()};
}

double per_second(double angle, Duration time) {
  return angle / std::chrono::duration<double>{time}.count();
}

struct StartCurrents {
  float least = 0.0F;
  float largest = 0.0F;
  bool is_seen = false;  ///< one was surely read between the first tick and the end of the start
};

/// Of a start, whose current is half of the first after some 8 ms.
StartCurrents start_currents(NodeBench& node, float volts) {
  constexpr int kMostReads = 60;
  constexpr auto kFirstTick = 5100us;
  constexpr auto kStart = 8ms;
  const auto earliest = node.now();
  node.send(kVoltage, volts);
  const auto begin = node.now();
  StartCurrents seen;
  for (int i = 0; i < kMostReads && (i == 0 || node.now() < begin + 30ms); ++i) {
    const auto asked = node.now();
    const float amperes = node.number(kReadCurrent);
    seen.is_seen |= asked > begin + kFirstTick && node.now() < earliest + kStart;
    seen.least = std::min(seen.least, amperes);
    seen.largest = std::max(seen.largest, amperes);
    node.pause(500us);
  }
  return seen;
}

void drive_and_let_go(NodeBench& node) {
  node.send(kVoltage, 1.5F);
  node.pause(300ms);
  node.send(kDisable);
}

/// Half a radian, by the stored controller.
void go_to_half(NodeBench& node) {
  node.send(kPosition, 0.5F);
  node.pause(1500ms);
}

/// How far a shaft that was driven turns on in a quarter of a second when nothing drives it.
float coast(NodeBench& node, std::optional<CommandId> brake) {
  drive_and_let_go(node);
  if (brake) node.send(*brake);
  return turned(node, 250ms);
}

/// With that command as far as without it. A gear may stop its shaft as fast as a brake.
template <CommandId brake>
void coasts(NodeBench& node) {
  constexpr float kLeastToTell = 0.02F;
  const float without = coast(node, {});
  if (without < kLeastToTell) {
    return node.skip("needs a shaft that coasts; this one stops as soon as nothing drives it");
  }
  const float with = coast(node, brake);
  node.expect_true(with > 0.7F * without, fmt::format("some {} rad, as without it", without),
                   fmt::format("a turn of {} rad", with));
}

/// A mode, and with which reference it drives a shaft that stands.
struct Drive {
  CommandId mode;
  float reference;
};
constexpr Drive kPositionDrive{kPosition, 0.5F};
constexpr Drive kSpeedDrive{kSpeed, 0.5F};
constexpr Drive kVoltageDrive{kVoltage, 1.5F};
constexpr Drive kDirectDrive{kDirectVoltage, 1.5F};
constexpr Drive kTorqueDrive{kTorque, 1.0F};

void drive_for_a_while(NodeBench& node, Drive drive) {
  node.send(drive.mode, drive.reference);
  node.pause(150ms);
}

/// While the shaft still turns.
template <Drive drive, CommandId end, MotorStatus status>
void ends(NodeBench& node) {
  drive_for_a_while(node, drive);
  node.expect_status(MotorStatus::kEnabled);
  node.send(end);
  node.settle();
  node.expect_status(status);
  node.expect_levels(0);
}

template <Drive drive>
constexpr auto kIsDisabled = on<ends<drive, kDisable, MotorStatus::kDisabled>>;
template <Drive drive>
constexpr auto kIsForgotten = on<ends<drive, kCalibrationUnknown, MotorStatus::kNeedsCalibration>>;

/// Where reads take long, the speed is known the less.
void expect_one_radian_a_second(NodeBench& node) {
  const auto before = read_angle(node);
  node.pause(200ms);
  const auto after = read_angle(node);
  const double angle = after.angle - before.angle;
  const double least = per_second(angle, after.latest - before.earliest);
  const double most = per_second(angle, after.earliest - before.latest);
  node.expect_true(least < 1.1 && most > 0.9, "a speed of 1 rad/s",
                   fmt::format("{:.3f} to {:.3f}", least, most));
}

void goes_at_one_radian_a_second(NodeBench& node) {
  node.send(kSpeed, 1.0F);
  node.pause(500ms);
  expect_one_radian_a_second(node);
  node.send(kDisable);
}

void goes_to_half(NodeBench& node) {
  go_to_half(node);
  node.expect_near(kReadAngle, 0.5, 0.03);
  node.send(kDisable);
}

template <Drive drive, void (*then)(NodeBench&)>
void after(NodeBench& node) {
  drive_for_a_while(node, drive);
  then(node);
}

template <Drive drive>
constexpr auto kThenSpeed = on<after<drive, goes_at_one_radian_a_second>>;
template <Drive drive>
constexpr auto kThenPosition = on<after<drive, goes_to_half>>;

/// What it is asked for is where it stands, which is far from where its angles begin.
template <CommandId mode>
void stays(NodeBench& node) {
  constexpr float kPlace = 1.0F;
  constexpr int kMostLevels = 2;  // a position is known to a count
  node.send(kCalibrateAngle, kPlace);
  const float angle = node.number(kReadAngle);
  node.send(mode, mode == kPosition ? angle : 0.0F);
  const auto end = node.now() + 60ms;
  while (!node.is_over() && node.now() < end) {
    const int levels = levels_of(double{node.number(kReadVoltage)});
    node.expect_true(std::abs(levels) <= kMostLevels, "next to no voltage",
                     fmt::format("{} levels", levels));
    node.pause(500us);
  }
  node.expect_near(kReadAngle, double{angle}, 0.005);
  node.send(kDisable);
}

/// A voltage, and between which speeds the shaft turned when it was computed, rad/s.
struct Turning {
  double volts;
  double least;
  double most;
};

/// A voltage is computed of the speed up to a tick before, which may be as far beyond what is seen
/// as the speed changes meanwhile.
Turning read_turning(NodeBench& node) {
  const auto first = read_angle(node);
  node.pause(10ms);
  const auto before = read_angle(node);
  const double volts{node.number(kReadVoltage)};
  node.pause(5ms);
  const auto after = read_angle(node);
  const auto speeds = [](const Reading& from, const Reading& to) {
    const double angle = to.angle - from.angle;
    return std::minmax({per_second(angle, to.latest - from.earliest),
                        per_second(angle, to.earliest - from.latest)});
  };
  const auto [least, most] = speeds(first, before);
  const auto [then_least, then_most] = speeds(before, after);
  const double change = std::fabs((then_least + then_most) - (least + most)) / 2;
  return {volts, std::min(least, then_least) - change, std::max(most, then_most) + change};
}

/// While the shaft gets faster or slower, the voltage is what `law` makes of its speed. Looks for a
/// while, and leaves the case open if nothing that was seen tells it from the voltage at rest.
template <class Law>
void expect_law(NodeBench& node, Law law) {
  constexpr double kSlack = 0.3;  // V: levels and counts
  constexpr double kTelling = 1;  // V
  bool is_told = false;
  for (const auto end = node.now() + 400ms; node.now() < end && !node.is_over();) {
    const auto seen = read_turning(node);
    const double low = law(seen.least) - kSlack;
    const double high = law(seen.most) + kSlack;
    is_told = is_told || low > law(0) + kTelling || high < law(0) - kTelling;
    node.expect_in_time({seen.volts, low, high, "V"},
                        fmt::format("{:.2f} to {:.2f} V at {:.2f} to {:.2f} rad/s", low, high,
                                    seen.least, seen.most),
                        fmt::format("{:.2f} V", seen.volts));
  }
  if (!is_told) node.leave_open("this shaft does not turn fast enough to tell");
}

/// Of a shaft that has turned for a while. The motion is compensated a tick late, which may take
/// half of the current away while the shaft gets faster.
void expect_torque_current(NodeBench& node, float torque) {
  constexpr double kLimited = 18;  // V, near the limit of the output
  node.send(kTorque, torque);
  node.pause(250ms);
  const double current{node.number(kReadCurrent)};
  const double volts{node.number(kReadVoltage)};
  node.send(kDisable);
  if (std::fabs(volts) > kLimited) return;
  const double wanted = MotorLaw{node.motor()}.current(double{torque});
  node.about(fmt::format("a torque of {} N m, 250 ms later", torque));
  node.expect_true(current > wanted / 3 && current < wanted * 1.5,
                   fmt::format("{:.3f} A, or half of that", wanted),
                   fmt::format("{:.3f} A", current));
}

template <int sign>
void keeps_torque(NodeBench& node) {
  constexpr double kTorqueAsked = sign * 1.0;  // N m
  constexpr double kMostVolts = 20;
  const MotorLaw law{node.motor()};
  node.send(kTorque, static_cast<float>(kTorqueAsked));
  expect_law(node, [&](double speed) {
    return std::clamp(law.torque_voltage(kTorqueAsked, speed), -kMostVolts, kMostVolts);
  });
  node.send(kDisable);
  node.pause(500ms);
  expect_torque_current(node, static_cast<float>(kTorqueAsked));
}

float turn_fast(NodeBench& node, int sign) {
  const float fast = static_cast<float>(sign * 4 * node.motor().standstill_levels) * kVoltsPerLevel;
  node.send(kVoltage, fast);
  node.pause(1s);
  return fast;
}

template <int sign>
void reverses_within_limit(NodeBench& node) {
  const MotorLaw law{node.motor()};
  const float back = -turn_fast(node, sign);
  node.send(kVoltage, back);
  expect_law(node, [&](double speed) { return law.limited(double{back}, speed); });
  node.send(kDisable);
}

/// The voltage at the first tick after one of 0; none if nobody knows that it was read before the
/// shaft had come to rest.
std::optional<double> first_of_brake(NodeBench& node, int sign) {
  constexpr auto kBrake = 12ms;
  const float fast = turn_fast(node, sign);
  const auto begin = node.now();
  node.send(kVoltage, 0.0F);
  while (!node.is_over() && node.now() - begin < kBrake) {
    const double volts{node.number(kReadVoltage)};
    if (std::fabs(volts - double{fast}) < 0.1) continue;
    return node.now() - begin < kBrake ? std::optional{volts} : std::nullopt;
  }
  return std::nullopt;
}

/// The lowest voltage of the next ticks; none if not each of them was looked at.
std::optional<double> lowest_voltage(NodeBench& node) {
  constexpr auto kSomeTicks = 16ms;
  constexpr auto kOftenEnough = 4ms;
  const auto end = node.now() + kSomeTicks;
  double lowest = std::numeric_limits<double>::infinity();
  for (auto last = node.now(); !node.is_over() && last < end;) {
    lowest = std::min(lowest, double{node.number(kReadVoltage)});
    if (node.now() - last > kOftenEnough) return std::nullopt;
    last = node.now();
  }
  return lowest;
}

/// After what begins a mode again a node takes the shaft for one at rest, for a tick.
template <class Deed>
void expect_limit_of_standstill(NodeBench& node, Deed begin_again) {
  constexpr int kTries = 5;
  std::optional<double> lowest;
  for (int i = 0; i < kTries && !lowest && !node.is_over(); ++i) {
    begin_again(turn_fast(node, 1));
    lowest = lowest_voltage(node);
  }
  node.send(kDisable);
  if (!lowest) return node.leave_open("this bus is too slow to be read once in each tick");
  const double most = (node.motor().standstill_levels + 1) * double{kVoltsPerLevel};
  node.expect_true(*lowest < most, fmt::format("a tick with less than {:.2f} V", most),
                   fmt::format("{:.2f} V or more", *lowest));
}

void limits_again_after_a_torque(NodeBench& node) {
  expect_limit_of_standstill(node, [&](float fast) {
    node.send(kTorque, 0.5F);
    node.pause(50ms);
    node.send(kVoltage, fast);
  });
}

void limits_again_with_parameters(NodeBench& node) {
  expect_limit_of_standstill(node, [&](float /*fast*/) {
    node.send(proportional(node.loop_rate(), 0.0F, ControllerKind::kSpeed));
  });
}

/// A node that shorted its motor at once would drive far more than the rated current.
template <int sign>
void brakes_within_limit(NodeBench& node) {
  constexpr int kTries = 5;
  constexpr double kLeast = 1;  // V
  std::optional<double> first;
  for (int i = 0; i < kTries && !first && !node.is_over(); ++i) first = first_of_brake(node, sign);
  node.send(kDisable);
  if (!first) return node.leave_open("this bus is too slow to be read while a shaft brakes");
  node.expect_true(sign * *first > kLeast, fmt::format("{} V or more at first", sign * kLeast),
                   fmt::format("{:.2f} V", *first));
}

/// More than at standstill, which the shaft gets as it turns faster.
template <int sign>
void reaches_voltage(NodeBench& node) {
  const int asked = sign * node.motor().standstill_levels * 3 / 2;
  node.send(kVoltage, static_cast<float>(asked) * kVoltsPerLevel);
  node.pause(1s);
  node.expect_levels(asked);
  node.send(kDisable);
}

/// The largest that is read at a start, of what the voltage drives at standstill. In real time
/// a start that is read late tells nothing of the least.
void reads_current_of_start(NodeBench& node) {
  constexpr float kVolts = 1.5F;
  constexpr double kReadingStep = 0.003;
  const double standstill = double{kVolts} / double{node.motor().known.constants.resistance};
  const int tries = node.noise() > Duration{} ? 5 : 1;
  StartCurrents seen;
  for (int i = 0; i < tries && seen.largest < 0.5 * standstill; ++i) {
    const auto start = start_currents(node, i % 2 == 0 ? kVolts : -kVolts);
    seen.largest = std::max(seen.largest, start.largest);
    seen.is_seen |= start.is_seen;
    node.send(kVoltage, 0.0F);  // a shaft that coasts starts the other way with more
    node.pause(500ms);
    node.send(kDisable);
  }
  node.expect_true(seen.largest <= 1.1 * standstill + kReadingStep,
                   fmt::format("at most {:.3f} A", standstill),
                   fmt::format("{:.3f} A", seen.largest));
  const bool is_seen = seen.largest >= 0.5 * standstill;
  if (!is_seen && !seen.is_seen) {
    node.leave_open("this bus is too slow to be read while a shaft starts");
  }
  node.expect_true(is_seen, fmt::format("about {:.3f} A", standstill),
                   fmt::format("{:.3f} A", seen.largest));
}

constexpr Case moving(std::string_view rule, CaseBody run) {
  return from(kFree, Hazard::kMove, rule, run);
}
constexpr Case moving(CaseBody run) { return from(kFree, Hazard::kMove, run); }

constexpr Clause kMotionClauses[] = {
    must("morap.motion.sense", "A positive voltage makes the angle larger.",
         "reference, encoder; recording loop-voltage"),
    moving("1.5 V.", on<sense<1>>),

    must("morap.motion.sense-negative", "A negative voltage makes the angle smaller.",
         "reference, encoder; recording loop-voltage"),
    moving("-1.5 V.", on<sense<-1>>),

    must("morap.motion.position",
         "With the stored controller a free shaft comes to its position reference.",
         "document, position; recording loop-position-default"),
    moving("0.5 rad in 1.5 s.", on<goes_to_half>),
    variant("after-speed", moving(kThenPosition<kSpeedDrive>)),
    variant("after-voltage", moving(kThenPosition<kVoltageDrive>)),

    must("morap.motion.speed",
         "With the stored controller a free shaft comes to its speed reference.",
         "document, speed; recording loop-speed-default"),
    moving("1 rad/s in half a second.", on<goes_at_one_radian_a_second>),
    variant("after-position", moving(kThenSpeed<kPositionDrive>)),
    variant("after-voltage", moving(kThenSpeed<kVoltageDrive>)),
    variant("with-another-rate", from(kFree, Hazard::kProgram,
                                      [](NodeBench& node) {
                                        node.send(kSpeed, 1.0F);
                                        node.pause(200ms);
                                        node.tune(TuneKind::kPiSpeed, 0.1F, -50.0F);
                                        node.pause(500ms);
                                        expect_one_radian_a_second(node);
                                        node.send(kDisable);
                                      })),

    must("morap.motion.stays",
         "A mode that begins with what keeps a shaft where it stands drives it nowhere, whatever "
         "its angle is.",
         "firmware, tick; recording static-mode-switch-locked", Profiles::kFirmware),
    variant("position", moving(on<stays<kPosition>>)),
    variant("speed", moving(on<stays<kSpeed>>)),
    variant("voltage", moving(on<stays<kVoltage>>)),
    variant("direct", moving(on<stays<kDirectVoltage>>)),
    variant("torque", moving(on<stays<kTorque>>)),

    must("morap.motion.holds", "At its position reference a shaft stays.",
         "document, position; recording loop-position-default"),
    moving("For 0.3 s.",
           [](NodeBench& node) {
             go_to_half(node);
             const float angle = turned(node, 300ms);
             node.expect_true(std::fabs(angle) < 0.01F, "no further turn",
                              fmt::format("{} rad", angle));
             node.send(kDisable);
           }),

    must("morap.motion.disabled", "A disabled shaft is driven no further.",
         "document; recording loop-disable-coast"),
    /// With little friction it coasts for long: it is at rest, or clearly slower than it was.
    moving("1.5 V, then 0.",
           [](NodeBench& node) {
             drive_and_let_go(node);
             const float before = std::fabs(turned(node, 300ms));
             node.pause(3s);
             const float angle = std::fabs(turned(node, 300ms));
             node.expect_true(angle < 0.01F || angle < 0.8F * before,
                              "a shaft at rest, or about to be",
                              fmt::format("{} rad in 0.3 s, and {} rad 3 s before", angle, before));
           }),

    must("morap.motion.latched", "A reference to an uncalibrated node does not move the shaft.",
         "document, motor status; recording loop-uncalibrated"),
    moving("1.5 V.",
           [](NodeBench& node) {
             node.send(kCalibrationUnknown);
             node.send(kVoltage, 1.5F);
             const float angle = turned(node, 300ms);
             node.expect_true(std::fabs(angle) < 0.01F, "a shaft at rest",
                              fmt::format("{} rad", angle));
             node.send(kCalibrationUnknown);
           }),

    must("morap.motion.current", "While it starts a current is read, which is never negative.",
         "document, current; recording loop-voltage"),
    /// In real time a machine that has no time may look too late, and gets further starts.
    moving("-1.5 V.",
           [](NodeBench& node) {
             const int tries = node.noise() > Duration{} ? 5 : 1;
             StartCurrents seen;
             for (int i = 0; i < tries && seen.largest <= 0.02F; ++i) {
               seen = start_currents(node, i % 2 == 0 ? -1.5F : 1.5F);
               node.expect_true(seen.least >= 0.0F, "no negative current",
                                fmt::format("{} A", seen.least));
             }
             if (seen.largest <= 0.02F && !seen.is_seen) {
               node.leave_open("this bus is too slow to be read while a shaft starts");
             }
             node.expect_true(seen.largest > 0.02F, "a positive current",
                              fmt::format("{} A", seen.largest));
             node.send(kDisable);
           }),

    must("morap.motion.open-loop",
         "What direct voltage and torque did to a shaft is over with the next mode.",
         "firmware, tick; recording static-mode-switch-locked", Profiles::kFirmware),
    variant("direct-position", moving(kThenPosition<kDirectDrive>)),
    variant("direct-speed", moving(kThenSpeed<kDirectDrive>)),
    variant("direct-disabled", moving(kIsDisabled<kDirectDrive>)),
    variant("direct-forgotten", moving(kIsForgotten<kDirectDrive>)),
    variant("torque-position", moving(kThenPosition<kTorqueDrive>)),
    variant("torque-speed", moving(kThenSpeed<kTorqueDrive>)),
    variant("torque-disabled", moving(kIsDisabled<kTorqueDrive>)),
    variant("torque-forgotten", moving(kIsForgotten<kTorqueDrive>)),

    must("morap.motion.ends",
         "In whatever mode it turns, a disabled shaft has neither a mode nor a voltage any more.",
         "document, motor status; firmware, status table"),
    variant("position", moving(kIsDisabled<kPositionDrive>)),
    variant("speed", moving(kIsDisabled<kSpeedDrive>)),
    variant("voltage", moving(kIsDisabled<kVoltageDrive>)),

    must("morap.motion.forgotten",
         "In whatever mode it turns, a shaft whose calibration is forgotten has neither a mode nor "
         "a voltage any more.",
         "document, motor status; firmware, status table"),
    variant("position", moving(kIsForgotten<kPositionDrive>)),
    variant("speed", moving(kIsForgotten<kSpeedDrive>)),
    variant("voltage", moving(kIsForgotten<kVoltageDrive>)),

    must("morap.motion.voltage",
         "A voltage beyond the limit at standstill is applied once the shaft turns fast enough.",
         "firmware, voltage mode; recording loop-voltage"),
    variant("forwards", moving(on<reaches_voltage<1>>)),
    variant("backwards", moving(on<reaches_voltage<-1>>)),

    must("morap.motion.limited",
         "Whatever it is asked for, the voltage of a shaft that turns is within what drives the "
         "rated current at its speed.",
         "firmware, voltage mode; recording stim-voltage"),
    variant("zero", moving(on<brakes_within_limit<1>>)),
    variant("zero-backwards", moving(on<brakes_within_limit<-1>>)),
    variant("reversed", moving(on<reverses_within_limit<1>>)),
    variant("reversed-backwards", moving(on<reverses_within_limit<-1>>)),

    must("morap.motion.limited-again",
         "For one tick after another mode, or after new parameters, a drive voltage is limited as "
         "at standstill.",
         "firmware, tick and voltage mode", Profiles::kFirmware),
    variant("torque", moving(on<limits_again_after_a_torque>)),
    variant("parameters", from(kFree, Hazard::kProgram, "New parameters of the speed controller.",
                               on<limits_again_with_parameters>)),

    must("morap.motion.torque",
         "A torque gets the voltage of its current and that of the motion, as fast as the shaft "
         "turns.",
         "firmware, torque mode; recording stim-torque", Profiles::kFirmware),
    variant("forwards", moving(on<keeps_torque<1>>)),
    variant("backwards", moving(on<keeps_torque<-1>>)),

    must("morap.motion.start-current",
         "At a start the current is that of the voltage at standstill, and never more.",
         "recording loop-voltage"),
    moving("1.5 V both ways.", on<reads_current_of_start>),

    must("morap.brake.no-effect", "Identifier 15 does not brake a disabled shaft.",
         "recording loop-disable-coast", Profiles::kFirmware),
    moving("1.5 V, 0, 15.", on<coasts<kBrake15>>),

    must("morap.brake.release", "After identifier 14 a disabled shaft turns freely.",
         "document, brake; recording loop-disable-coast"),
    moving("1.5 V, 0, 14.", on<coasts<kBrake14>>),
};

}  // namespace

Chapter motion_chapter() { return chapter("A free shaft", kMotionClauses); }

}  // namespace armjig::morap::conformance
