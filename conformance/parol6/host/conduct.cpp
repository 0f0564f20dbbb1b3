// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/host/conduct.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>

#include "conformance/parol6/host/occasions.hpp"
#include "harness/wire/parol6/joint_bounds.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::programs {
namespace {

using namespace std::chrono_literals;

/// In which a program has to see that the emergency stop is pressed, and a joint at its bound.
constexpr Duration kReaction = 100ms;
constexpr Duration kLongestGap = 100ms;
/// A host that is silent for so long has gone.
constexpr Duration kGone = 1s;
/// Frames that come together after that much for each of them were held up by the link.
constexpr Duration kShortPeriod = 8ms;
constexpr Duration kLongestHome = 1s;
/// A set-point that is repeated so long is where the move ends.
constexpr Duration kRest = 200ms;
constexpr Duration kEffect = 500ms;
/// Slower joints may stand for longer than `kEffect`.
constexpr std::int32_t kNoticeable = 10;

/// The most that either of the known hosts asks for; the GUI's and the Python API's tables differ.
constexpr GoToWay::Limits kFastest{StepsPerSecond{15'000}, StepsPerSecond{25'000},
                                   StepsPerSecond{32'000}, StepsPerSecond{22'000},
                                   StepsPerSecond{22'000}, StepsPerSecond{27'000}};

/// Code 69 is an offence of its own (parol6.host.no-demo).
constexpr bool is_move(Command command) noexcept {
  return moves(command) && command != Command::kDemo;
}

/// The same but for what goes along with any command.
bool is_same_motion(const CommandFrame& a, const CommandFrame& b) noexcept {
  const bool minds_position = a.command == Command::kGoTo;
  return a.command == b.command && a.speed == b.speed &&
         (!minds_position || a.position == b.position);
}

bool has_speed(const CommandFrame& frame) noexcept {
  return std::ranges::any_of(frame.speed, [](StepsPerSecond speed) { return speed.value != 0; });
}

int code(Command command) noexcept { return static_cast<int>(command); }

}  // namespace

Conduct::Conduct(Duration noise) noexcept : noise_{noise}, way_{kFastest, noise} {}

bool Conduct::is_arm_homed() const noexcept { return telemetry_ && is_homed(*telemetry_); }

/// Whether the last frame makes joints move, and goes on doing so.
bool Conduct::has_joints_move() const noexcept {
  if (!latched_ || !telemetry_ || !is_enabled_) return false;
  switch (latched_->command) {
    case Command::kJog:
      return has_speed(*latched_);
    case Command::kGoTo:
      return latched_->position != telemetry_->position;
    case Command::kHome:
      return true;
    case Command::kIdle:
      return homing_ != Homing::kNo;
    default:
      return false;
  }
}

void Conduct::command(Instant time, const CommandFrame& frame, const Complain& complain_now) {
  const auto complain = complain_now.resting_on({.since = time});
  note_occasions(frame, complain);
  if (latched_) judge_order(time, frame, complain);
  judge_permission(frame, complain);
  judge_estop(time, frame, complain);
  judge_homing(time, frame, complain);
  judge_motion(time, frame, complain);
  latched_ = frame;
  latched_at_ = time;
  has_fallen_silent_ = false;
}

void Conduct::note_occasions(const CommandFrame& frame, const Complain& complain) const {
  const auto note = [&complain](bool is_one, std::string_view what) {
    if (is_one) complain.occasion(what);
  };
  const bool is_go_to = frame.command == Command::kGoTo;
  const bool is_jog = frame.command == Command::kJog;
  note(frame.command != Command::kIdle, occasion::kCommand);
  note(frame.command == Command::kHome, occasion::kHome);
  note(is_move(frame.command), occasion::kMove);
  note(is_go_to, occasion::kGoTo);
  note(is_jog, occasion::kJog);
  note(is_go_to && is_arm_homed(), occasion::kHomedGoTo);
  note(is_jog && is_arm_homed(), occasion::kHomedJog);
  note(is_estop_pressed(), occasion::kEstop);
}

/// Lets the frame before act, if it had the time, and judges what came between.
void Conduct::judge_order(Instant time, const CommandFrame& frame, const Complain& complain) {
  if (time > latched_at_) {
    act(latched_at_, *latched_);
    judge_silence(time, complain);
    gap_before_ = time - latched_at_;
    together_ = 1;
    return;
  }
  ++together_;
  const bool is_lost = latched_->command != frame.command && latched_->command != Command::kIdle;
  const bool may_be_late = noise_ > Duration::zero() && gap_before_ > together_ * kShortPeriod;
  if (may_be_late) act(latched_at_, *latched_);  // as the program means it
  if (!is_lost || may_be_late) return;
  complain("parol6.host.overwritten", fmt::format("code {} was followed at once by code {}",
                                                  code(latched_->command), code(frame.command)));
}

void Conduct::act(Instant time, const CommandFrame& frame) {
  if (frame.command == Command::kEnable) is_enabled_ = true;
  if (frame.command == Command::kDisable) is_enabled_ = false;
  if (frame.command == Command::kHome && is_enabled_ && homing_ == Homing::kNo) {
    homing_ = Homing::kAsked;
  }
  if (ends_homing(frame.command)) homing_ = Homing::kNo;
  const bool can_be_held = frame.command == Command::kJog || frame.command == Command::kGoTo;
  if (!can_be_held || !telemetry_) {
    held_.reset();
  } else if (!held_ || !is_same_motion(held_->frame, frame)) {
    held_ = Held{.frame = frame, .since = time, .position = telemetry_->position};
  }
}

void Conduct::judge_silence(Instant time, const Complain& complain) {
  if (!has_joints_move()) return;
  complain.occasion(occasion::kMotion);
  const auto gap = time - latched_at_;
  if (gap <= kLongestGap || has_fallen_silent_) return;
  complain("parol6.host.gap-in-motion",
           fmt::format("{:.0f} ms passed without a frame after code {}", milliseconds(gap),
                       code(latched_->command)),
           {.since = latched_at_, .beyond = gap - kLongestGap});
}

void Conduct::wait_until(Instant time, const Complain& complain) {
  call_silent(time, kGone, complain);
}

void Conduct::finish(Instant time, const Complain& complain) {
  call_silent(time, kLongestGap, complain);
}

void Conduct::call_silent(Instant time, Duration longest, const Complain& complain) {
  const auto silence = time - latched_at_;
  if (!latched_ || has_fallen_silent_ || silence <= longest) return;
  act(latched_at_, *latched_);
  if (!has_joints_move()) return;
  complain.occasion(occasion::kMotion);
  has_fallen_silent_ = complain("parol6.host.silent-in-motion",
                                fmt::format("no frame came for {:.0f} ms after code {}",
                                            milliseconds(silence), code(latched_->command)),
                                {.since = latched_at_, .beyond = silence - longest});
}

void Conduct::judge_permission(const CommandFrame& frame, const Complain& complain) const {
  if (!is_move(frame.command)) return;
  if (!telemetry_) {
    complain("parol6.host.looks-first", fmt::format("code {} came first", code(frame.command)));
  } else if (is_estop_pressed()) {
    return;  // parol6.host.estop-stays
  } else if (!is_enabled_) {
    complain("parol6.host.move-disabled",
             fmt::format("code {} came to a disabled board", code(frame.command)));
  } else if (frame.command == Command::kGoTo && homing_ == Homing::kNo && !is_arm_homed()) {
    complain("parol6.host.go-to-unhomed",
             fmt::format("a go-to came while homed was 0x{:02X}", telemetry_->homed));
  }
}

void Conduct::judge_estop(Instant time, const CommandFrame& frame, const Complain& complain) {
  if (!is_estop_pressed()) return;
  if (frame.command == Command::kDisable) {
    has_disabled_ = true;
    return;
  }
  if (has_disabled_ && (is_move(frame.command) || frame.command == Command::kEnable)) {
    complain("parol6.host.estop-stays", fmt::format("code {} came while the emergency stop was "
                                                    "pressed",
                                                    code(frame.command)));
  } else if (!has_disabled_ && !has_ignored_stop_ && time - *pressed_since_ > kReaction) {
    has_ignored_stop_ =
        complain("parol6.host.estop-disables",
                 fmt::format("no disable came in {:.0f} ms, but code {}",
                             milliseconds(time - *pressed_since_), code(frame.command)),
                 {.since = *pressed_since_, .beyond = time - *pressed_since_ - kReaction});
  }
}

void Conduct::judge_homing(Instant time, const CommandFrame& frame, const Complain& complain) {
  if (frame.command != Command::kHome) {
    home_since_.reset();
  } else if (!home_since_) {
    home_since_ = time;
  } else if (time - *home_since_ > kLongestHome) {
    complain("parol6.host.home-held", "home was held for more than a second",
             {.since = *home_since_, .beyond = time - *home_since_ - kLongestHome});
  }
  const bool may_come = frame.command == Command::kIdle || frame.command == Command::kHome ||
                        frame.command == Command::kDisable;
  const bool disturbs = ends_homing(frame.command) && !may_come;
  if (homing_ != Homing::kNo && disturbs) {
    complain("parol6.host.home-disturbed",
             fmt::format("code {} came while homed was 0x{:02X}", code(frame.command),
                         telemetry_ ? telemetry_->homed : 0));
  }
}

void Conduct::judge_motion(Instant time, const CommandFrame& frame, const Complain& complain) {
  if (frame.command == Command::kIdle && has_speed(frame)) {
    complain("parol6.host.idle-speed", "an idle frame came with a speed");
  }
  if (frame.command != Command::kJog) outward_since_.reset();
  const bool is_obeyed = telemetry_ && is_enabled_ && !is_estop_pressed();
  if (frame.command != Command::kGoTo || !is_obeyed || !is_arm_homed()) way_.end();
  if (!is_obeyed) return;
  if (frame.command == Command::kJog) judge_jog(time, frame, complain);
  if (frame.command == Command::kGoTo) judge_go_to(time, frame, complain);
  judge_held(time, frame, complain);
}

void Conduct::judge_jog(Instant time, const CommandFrame& frame, const Complain& complain) {
  bool leads_out = false;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto speed = frame.speed[j];
    if (std::abs(speed.value) > kFastest[j].value) {
      complain("parol6.host.jog-pace",
               fmt::format("j{} was jogged at {} steps/s, {} is the most of known hosts", j + 1,
                           speed.value, kFastest[j].value));
    }
    if (is_arm_homed() && kJointBounds[j].forbid(telemetry_->position[j], speed)) {
      leads_out = true;
      if (outward_since_ && time - *outward_since_ > kReaction) {
        complain("parol6.host.jog-bound",
                 fmt::format("j{} was jogged at {} steps/s, and stood at "
                             "{}",
                             j + 1, speed.value, telemetry_->position[j].value));
      }
    }
  }
  if (!leads_out) {
    outward_since_.reset();
  } else if (!outward_since_) {
    outward_since_ = time;
  }
}

void Conduct::judge_go_to(Instant time, const CommandFrame& frame, const Complain& complain) {
  if (!is_arm_homed()) return;
  constexpr Steps kRounding{1};  // the two hosts round their limits differently
  std::array<bool, kJointCount> leads_out{};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    auto bounds = kJointBounds[j];
    bounds.lower = bounds.lower - kRounding;
    bounds.upper = bounds.upper + kRounding;
    leads_out[j] = way_.leads_out(j, bounds, frame.position[j], telemetry_->position[j]);
    if (!leads_out[j]) continue;
    complain("parol6.host.go-to-range",
             fmt::format("j{} was sent to {}, from {} to {} is its range", j + 1,
                         frame.position[j].value, kJointBounds[j].lower.value,
                         kJointBounds[j].upper.value));
  }
  for (const auto& excess : way_.go_on(time, frame, telemetry_->position)) {
    if (leads_out[excess.joint]) continue;
    complain("parol6.host.go-to-pace",
             fmt::format("j{} was to {}, {} steps/s is the most of known hosts", excess.joint + 1,
                         describe(excess), kFastest[excess.joint].value));
  }
}

void Conduct::judge_held(Instant time, const CommandFrame& frame, const Complain& complain) {
  if (!held_ || held_->is_judged || !is_same_motion(held_->frame, frame)) return;
  const auto held_for = time - held_->since;
  held_->has_moved = held_->has_moved || telemetry_->position != held_->position;
  const bool is_go_to = frame.command == Command::kGoTo;
  if (is_go_to && has_speed(frame) && held_->has_moved && held_for > kRest) {
    held_->is_judged = true;
    complain("parol6.host.go-to-rest",
             fmt::format("a go-to was held for {:.0f} ms with a speed", milliseconds(held_for)),
             {.since = held_->since});
  } else if (held_for > kEffect && !held_->has_moved) {
    const bool wants_motion = is_go_to ? frame.position != telemetry_->position
                                       : std::ranges::any_of(frame.speed, [](StepsPerSecond speed) {
                                           return std::abs(speed.value) >= kNoticeable;
                                         });
    if (!wants_motion) return;
    held_->is_judged = true;
    complain("parol6.host.no-effect",
             fmt::format("code {} was held for {:.0f} ms and nothing moved", code(frame.command),
                         milliseconds(held_for)),
             {.since = held_->since});
  }
}

void Conduct::telemetry(Instant time, const TelemetryFrame& frame) {
  telemetry_ = frame;
  if (!parol6::is_estop_pressed(frame)) {
    pressed_since_.reset();
    has_disabled_ = false;
    has_ignored_stop_ = false;
  } else if (!pressed_since_) {
    pressed_since_ = time;
  }
  if (homing_ == Homing::kAsked && !is_homed(frame)) homing_ = Homing::kRuns;
  if (homing_ == Homing::kRuns && is_homed(frame)) homing_ = Homing::kNo;
}

}  // namespace armjig::parol6::programs
