// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/tuner.hpp"

#include <cmath>
#include <limits>

// Compiled with -ffp-contract=off, as everything under emulators/. The order of the operations is
// the firmware's: exact arithmetic would cancel what shows in the last bits here.
namespace armjig::morap::emulation {
namespace {

/// What the three designs share.
struct Design {
  float g0{};  ///< gain of the motor
  float g1{};  ///< its open-loop pole is at -g1
  float w{};   ///< the pole asked for, never faster than the motor
  float g{};   ///< the pole of the rest
  float a{};   ///< real part of the pair of poles of a position loop
  float p{};   ///< its distance from 0, squared
};

/// A first-order controller in continuous time, and the integral beside it.
struct Continuous {
  float r0{};
  float s1{};
  float s0{};
  float t1{};
  float t0{};
  float integral{};
};

Design design_for(const TuneRequest& request, const MotorConstants& m) noexcept {
  const float inertia = request.inertia;
  Design design;
  design.g0 = m.efficiency * m.torque_constant * m.gear_ratio / (m.resistance * inertia);
  design.g1 = (m.efficiency * m.gear_ratio * m.gear_ratio * m.torque_constant * m.torque_constant +
               m.resistance * m.friction) /
              (m.resistance * inertia);
  design.w = request.pole < -design.g1 ? -design.g1 : request.pole;
  design.g = -design.g1;
  design.a = 0.99F * design.w;
  const float b = 0.1407F * design.w;
  design.p = design.a * design.a + b * b;
  return design;
}

Coefficients pair(float older, float newer) noexcept { return {2, {older, newer}}; }

/// Tustin's rule for the first-order part.
ControllerSet discretise(ControllerKind kind, std::uint16_t rate_hz,
                         const Continuous& law) noexcept {
  const float ts = 1.0F / static_cast<float>(rate_hz);
  const float mr = ts * law.r0 + 2.0F;
  ControllerSet set{kind, rate_hz, {}, {}, {}, law.integral * ts};
  set.d = pair((ts * law.s0 - 2.0F * law.s1) / mr, (2.0F * law.s1 + ts * law.s0) / mr);
  set.c = pair((ts * law.t0 - 2.0F * law.t1) / mr, (2.0F * law.t1 + ts * law.t0) / mr);
  set.f = {1, {(ts * law.r0 - 2.0F) / mr}};
  return set;
}

std::uint16_t position_rate(float g) noexcept { return g < -70.0F ? 625 : 400; }

std::uint16_t speed_rate(float g) noexcept {
  if (g < -150.0F) return 625;
  return g < -100.0F ? 400 : 320;
}

ControllerSet pd_position(const Design& design) noexcept {
  const auto& [g0, g1, w, g, a, p] = design;
  const auto rate = position_rate(g);
  const float ts = 1.0F / static_cast<float>(rate);
  Continuous law;
  law.r0 = -g1 - a - a - g;
  law.s0 = -(p * g) / g0;
  law.s1 = (2.0F * g1 * a + g1 * g + p + 2.0F * g * a + g1 * g1) / g0;
  law.t1 = p / g0;
  auto set = discretise(ControllerKind::kPosition, rate, law);
  // The zero of the reference path is written differently in the firmware, and rounds differently.
  const float mr = ts * law.r0 + 2.0F;
  const float q = ts * law.t1 * g;
  set.c = pair(-(2.0F * law.t1 + q) / mr, (2.0F * law.t1 - q) / mr);
  return set;
}

ControllerSet pid_position(const Design& design) noexcept {
  const auto& [g0, g1, w, g, a, p] = design;
  const float r0 = -g1 - 2.0F * a - g - g;
  const float s0 = p * g * g / g0;
  const float s1 = -(p * g + p * g + 2.0F * a * g * g) / g0;
  const float s2 =
      (2.0F * g1 * a + g1 * g + g1 * g + p + 2.0F * a * g + 2.0F * a * g + g * g + g1 * g1) / g0;
  const float t2 = p / g0;
  const float t1 = -t2 * (g + g);
  const float t0 = t2 * g * g;
  return discretise(ControllerKind::kPosition, position_rate(g),
                    {r0, s2, s1 - s0 / r0, t2, t1 - t0 / r0, s0 / r0});
}

ControllerSet pi_speed(const Design& design) noexcept {
  const auto& [g0, g1, w, g, a, p] = design;
  const float r0 = -g1 - w - g - g;
  const float s0 = -(w * g * g) / g0;
  const float s1 = (g1 * w + g1 * g + g1 * g + w * g + w * g + g * g + g1 * g1) / g0;
  const float t2 = -w / g0;
  const float t1 = -t2 * (g + g);
  const float t0 = t2 * g * g;
  return discretise(ControllerKind::kSpeed, speed_rate(g),
                    {r0, 0.0F, s1 - s0 / r0, t2, t1 - t0 / r0, s0 / r0});
}

ControllerSet designed(TuneKind kind, const Design& design) noexcept {
  switch (kind) {
    case TuneKind::kPdPosition:
      return pd_position(design);
    case TuneKind::kPidPosition:
      return pid_position(design);
    case TuneKind::kPiSpeed:
      break;
  }
  return pi_speed(design);
}

/// Which sign and payload a NaN has that was computed is the compiler's choice; ours is always the
/// same.
float with_plain_nan(float number) noexcept {
  return std::isnan(number) ? std::numeric_limits<float>::quiet_NaN() : number;
}

ControllerSet with_plain_nans(ControllerSet set) noexcept {
  for (auto* const coefficients : {&set.c, &set.d, &set.f}) {
    for (auto& number : coefficients->values) number = with_plain_nan(number);
  }
  set.integral = with_plain_nan(set.integral);
  return set;
}

bool is_refused(const TuneRequest& request, const Profile& profile) noexcept {
  const auto& [kind, inertia, pole] = request;
  if (inertia < 0.0F || inertia > kLargestInertia || pole > 0.0F || pole < kFastestPole)
    return true;
  if (kind > TuneKind::kPiSpeed) return true;
  return profile.refuses_unstable_tuning && (inertia == 0.0F || pole == 0.0F);
}

}  // namespace

std::optional<ControllerSet> tune(const TuneRequest& request, const MotorConstants& motor,
                                  const Profile& profile) noexcept {
  if (is_refused(request, profile)) return std::nullopt;
  return with_plain_nans(designed(request.kind, design_for(request, motor)));
}

}  // namespace armjig::morap::emulation
