// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/parol6_judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "harness/rig/parol6_receiver.hpp"
#include "harness/wire/parol6/go_to_way.hpp"
#include "harness/wire/parol6/readings.hpp"
#include "harness/wire/parol6/splitter.hpp"
#include "harness/wire/steps.hpp"

namespace armjig::parol6::rig {
namespace {

/// So many frames without any answer, half a second at 100 Hz, and the arm counts as out of sight.
constexpr int kOutOfSight = 50;

/// A joint at its bound may overshoot by what it goes in a fiftieth of a second, the time in which
/// the board closes a distance.
constexpr int kOvershoot = 50;

/// Ends whatever frame a receiver is in and begins none. At worst (parol6.receive.length-zero) a
/// length of 0 takes 256 of these bytes, the last of them as a length, hence 85 more.
constexpr std::size_t kFlushSize = 512;
constexpr std::byte kFlush{0x55};

/// After the flush a whole store of zeros that is not accepted, since it does not end well: the
/// shipped board keeps there what earlier frames left, and shorter ones uncover it.
constexpr auto kOpening = [] {
  std::array<std::byte, kFlushSize + kHeaderSize + kLongestPayload> bytes{};
  std::fill_n(bytes.begin(), kFlushSize, kFlush);
  std::fill_n(bytes.begin() + kFlushSize, kStartSize, kStartByte);
  bytes[kFlushSize + kStartSize] = std::byte{kLongestPayload};
  return bytes;
}();

/// Where a go-to comes to rest: off its target, where the distance outweighs the commanded speed
/// (parol6.goto.law).
Steps resting_place(Steps goal, StepsPerSecond feed) noexcept {
  return goal + Steps{feed.value / 100};
}

/// Whether a gripper set-point does anything that the one in the frame before did not
/// (parol6.gripper.one-frame).
bool is_gripper_action(GripperSetPoint set_point, const GripperSetPoint& before) noexcept {
  if (set_point.mode != gripper_mode::kMove) return true;
  set_point.mode = before.mode;
  return set_point != before;
}

constexpr GoToWay::Limits kTopSpeeds = of_joints(&Joint::max_speed);

/// What a board does, as far as our writes and its answers tell.
class Belief {
 public:
  [[nodiscard]] GoToWay& way() noexcept { return way_; }
  [[nodiscard]] const GoToWay& way() const noexcept { return way_; }
  [[nodiscard]] const CommandFrame& latched() const noexcept { return latched_; }

  void accept(const CommandFrame& frame) noexcept {
    if (frame.command == Command::kHome) {
      if (latched_.command != Command::kHome) was_unhomed_ = false;
      may_be_homing_ = true;
    }
    if (moves(frame.command)) is_unheard_ = true;
    if (frame.command != Command::kGoTo) way_.end();
    latched_ = frame;
  }

  /// What ends motion counts only when the board says that it has it: it may be lost, and of
  /// several frames that arrive at once only the last one acts.
  void observe(const TelemetryFrame& telemetry) noexcept {
    const bool is_echo = telemetry.echo == latched_.command;
    was_unhomed_ = was_unhomed_ || !is_homed(telemetry);
    const bool has_homed =
        is_homed(telemetry) && was_unhomed_ && latched_.command != Command::kHome;
    if (has_homed || (is_echo && ends_homing(latched_.command))) may_be_homing_ = false;
    if (is_echo && !moves(latched_.command)) is_unheard_ = false;
    if (!is_echo && moves(telemetry.echo)) is_unheard_ = true;
  }

  [[nodiscard]] bool may_be_homing() const noexcept { return may_be_homing_; }

  [[nodiscard]] bool may_be_moving() const noexcept {
    return moves(latched_.command) || may_be_homing_ || is_unheard_;
  }

 private:
  CommandFrame latched_{};
  GoToWay way_{kTopSpeeds};
  bool may_be_homing_ = false;
  bool was_unhomed_ = false;  ///< since it was told to home
  bool is_unheard_ = false;   ///< whether the end of a motion was heard
};

using Verdict = std::optional<Refusal>;

/// Calls `accept` for each frame that the shipped board finds, until it refuses one.
template <class Accept>
Verdict for_each_frame(ShippedReceiver& receiver, Bytes bytes, Accept accept) {
  for (const auto byte : bytes) {
    if (!receiver.take(byte)) continue;
    if (auto refusal = accept(decode_command(receiver.body()))) return refusal;
  }
  return std::nullopt;
}

/// The same for whatever looks like a frame at any place. That is more than any strict receiver
/// finds, however it finds its way back behind damage and whichever check byte it wants.
template <class Accept>
Verdict for_each_window(Bytes bytes, Accept accept) {
  for (; bytes.size() >= kCommandFrameSize; bytes = bytes.subspan(1)) {
    const auto window = bytes.first<kCommandFrameSize>();
    const bool is_frame =
        std::ranges::count(window.first<kStartSize>(), kStartByte) == kStartSize &&
        window[kStartSize] == std::byte{kCommandPayloadSize} &&
        std::ranges::equal(window.last<kEndBytes.size()>(), kEndBytes);
    if (!is_frame) continue;
    if (auto refusal = accept(decode_command(body_of(window)))) return refusal;
  }
  return std::nullopt;
}

class BoardJudge final : public OneStopJudge {
 public:
  BoardJudge() {
    stop_by(stop_);
    recent_.reserve(4096);
    std::fill_n(stop_.begin(), kFlushSize, kFlush);
    renew_stop();
  }

  [[nodiscard]] Bytes opening_bytes() const override { return kOpening; }

  void set_time(Instant now) override { now_ = now; }

  std::optional<Refusal> judge(Messages messages, const Permissions& permissions) override {
    const auto bytes = messages.front();
    auto receiver = receiver_;
    auto shipped = shipped_;
    auto strict = strict_;
    auto asked = unanswered_;
    const auto known = recent_.size();
    recent_.insert(recent_.end(), bytes.begin(), bytes.end());
    const auto judge_and_accept = [&](Belief& board) {
      return [&](const CommandFrame& frame) -> Verdict {
        if (auto refusal = judge_frame(frame, board, permissions)) return refusal;
        board.accept(frame);
        return std::nullopt;
      };
    };
    auto refusal = for_each_frame(receiver, bytes, [&](const CommandFrame& frame) {
      ++asked;
      return judge_and_accept(shipped)(frame);
    });
    if (!refusal) refusal = for_each_window(recent_, judge_and_accept(strict));
    if (refusal) {
      recent_.resize(known);
      return refusal;
    }
    receiver_ = receiver;
    shipped_ = shipped;
    strict_ = strict;
    unanswered_ = asked;
    forget_all_but(kCommandFrameSize - 1);
    renew_stop();
    return std::nullopt;
  }

  void observe(Bytes bytes) override {
    for_each_step(splitter_, bytes, [this](const Splitter::Step& step) {
      const auto telemetry = telemetry_of(step);
      if (!telemetry) return;
      const auto before = std::exchange(telemetry_, telemetry);
      stands_ = before && before->position == telemetry_->position;
      unanswered_ = 0;
      if (may_be_moving() && !stop_reason_) stop_reason_ = reason_to_stop(before);
      shipped_.observe(*telemetry_);
      strict_.observe(*telemetry_);
    });
  }

  std::optional<std::string> must_stop() override {
    auto reason = std::exchange(stop_reason_, std::nullopt);
    return may_be_moving() ? reason : std::nullopt;
  }

  [[nodiscard]] Refusal::Matter matter_of_stop() const override { return matter_of_stop_; }

  [[nodiscard]] bool may_be_moving() const override {
    return shipped_.may_be_moving() || strict_.may_be_moving();
  }

 private:
  /// Outputs and gripper stay as they are: a load must not fall because the arm stops.
  void renew_stop() noexcept {
    auto frame = shipped_.latched();
    frame.command = Command::kDisable;
    frame.speed = {};
    frame.check = kCheckHost;
    frame.gripper.mode = gripper_mode::kMove;
    std::ranges::copy(encode(frame), stop_.begin() + kFlushSize);
  }

  void forget_all_but(std::size_t size) {
    const auto surplus = recent_.size() - std::min(recent_.size(), size);
    recent_.erase(recent_.begin(), recent_.begin() + static_cast<std::ptrdiff_t>(surplus));
  }

  [[nodiscard]] bool is_arm_homed() const noexcept { return telemetry_ && is_homed(*telemetry_); }

  [[nodiscard]] Verdict judge_frame(const CommandFrame& frame, Belief& board,
                                    const Permissions& permissions) const {
    const auto& before = board.latched();
    const auto needs = [&](Hazard hazard, std::string_view what) {
      return demand(hazard, permissions, what);
    };
    if (((frame.in_out ^ before.in_out) & io_flag::kOutputs) != 0) {
      if (auto refusal = needs(Hazard::kState, "switching an output")) return refusal;
    }
    if (is_gripper_action(frame.gripper, before.gripper)) {
      if (auto refusal = needs(Hazard::kGrip, "a gripper set-point")) return refusal;
    }
    switch (frame.command) {
      case Command::kEnable:
        return needs(Hazard::kState, "enable");
      case Command::kClearError:
        return needs(Hazard::kState, "clear error");
      case Command::kHome:
        if (auto refusal = needs(Hazard::kHome, "home")) return refusal;
        return refuse_when_unsafe(Hazard::kHome);
      case Command::kJog:
        if (auto refusal = needs(Hazard::kMove, "jog")) return refusal;
        if (auto refusal = refuse_when_unsafe(Hazard::kMove)) return refusal;
        return judge_jog(frame);
      case Command::kGoTo:
        if (auto refusal = needs(Hazard::kMove, "go-to")) return refusal;
        if (auto refusal = refuse_when_unsafe(Hazard::kMove)) return refusal;
        if (board.may_be_homing() && leads_nowhere(frame)) return std::nullopt;
        return judge_go_to(frame, board.way());
      case Command::kDemo:
        if (auto refusal = needs(Hazard::kMove, "the demonstration")) return refusal;
        if (!is_arm_homed()) {
          return Refusal{
              Hazard::kMove,
              "code 69 moves all joints far and cannot be disabled: it needs a homed arm"};
        }
        return refuse_when_unsafe(Hazard::kMove);
      case Command::kIdle:
      case Command::kDisable:
        break;
    }
    return std::nullopt;
  }

  [[nodiscard]] Verdict refuse_when_unsafe(Hazard hazard) const {
    if (telemetry_ && is_estop_pressed(*telemetry_)) {
      return Refusal{hazard, "the emergency stop is pressed", Refusal::Cause::kDevice,
                     Refusal::Matter::kStopped};
    }
    if (unanswered_ >= kOutOfSight) {
      return Refusal{hazard,
                     fmt::format("the board has not answered {} frames, so nobody could see its "
                                 "emergency stop",
                                 unanswered_),
                     Refusal::Cause::kDevice, Refusal::Matter::kUnseen};
    }
    return std::nullopt;
  }

  [[nodiscard]] Verdict judge_jog(const CommandFrame& frame) const {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto speed = frame.speed[j];
      if (std::abs(speed.value) > kJoints[j].max_jog.value) {
        return Refusal{Hazard::kMove, fmt::format("j{} may jog at most at {} steps/s", j + 1,
                                                  kJoints[j].max_jog.value)};
      }
      if (is_arm_homed() && kJointBounds[j].forbid(telemetry_->position[j], speed)) {
        return Refusal{Hazard::kMove, fmt::format("j{} is at its bound", j + 1),
                       Refusal::Cause::kDevice};
      }
    }
    return std::nullopt;
  }

  /// To where an arm that stands says to be. That ends homing, and moves nothing.
  [[nodiscard]] bool leads_nowhere(const CommandFrame& frame) const {
    constexpr std::array<StepsPerSecond, kJointCount> kNoSpeeds{};
    return stands_ && unanswered_ == 0 && frame.position == telemetry_->position &&
           frame.speed == kNoSpeeds;
  }

  [[nodiscard]] Verdict judge_go_to(const CommandFrame& frame, GoToWay& way) const {
    if (!is_arm_homed()) return Refusal{Hazard::kMove, "go-to needs a homed arm"};
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto& bounds = kJointBounds[j];
      const auto leads_out = [&](Steps place) {
        return way.leads_out(j, bounds, place, telemetry_->position[j]);
      };
      const auto goal = frame.position[j];
      if (leads_out(goal) || leads_out(resting_place(goal, frame.speed[j]))) {
        return Refusal{Hazard::kMove, fmt::format("j{} may go from {} to {} steps", j + 1,
                                                  bounds.lower.value, bounds.upper.value)};
      }
    }
    const auto excesses = way.go_on(now_, frame, telemetry_->position);
    if (excesses.empty()) return std::nullopt;
    const auto& excess = excesses.front();
    return Refusal{Hazard::kMove, fmt::format("j{} would {}, {} steps/s are allowed: send the way "
                                              "in smaller pieces",
                                              excess.joint + 1, describe(excess),
                                              kJoints[excess.joint].max_speed.value)};
  }

  [[nodiscard]] std::optional<std::string> reason_to_stop(
      const std::optional<TelemetryFrame>& before) {
    const bool is_stopped = is_estop_pressed(*telemetry_);
    matter_of_stop_ = is_stopped ? Refusal::Matter::kStopped : Refusal::Matter::kAstray;
    if (is_stopped) return "the emergency stop was pressed";
    if (const auto j = runaway(before)) {
      return fmt::format("j{} is at {} steps, beyond its range, and goes further", *j + 1,
                         telemetry_->position[*j].value);
    }
    for (const auto* board : {&shipped_, &strict_}) {
      if (const auto j = board->way().stray(now_, telemetry_->position)) {
        return fmt::format("j{} is at {} steps and does not follow its set-points", *j + 1,
                           telemetry_->position[*j].value);
      }
      if (!is_arm_homed() || board->latched().command != Command::kJog) continue;
      for (std::size_t j = 0; j < kJointCount; ++j) {
        if (kJointBounds[j].forbid(telemetry_->position[j], board->latched().speed[j])) {
          return fmt::format("j{} reached its bound", j + 1);
        }
      }
    }
    return std::nullopt;
  }

  /// A joint of a homed arm that is beyond its range and on its way out, whatever it was told.
  [[nodiscard]] std::optional<std::size_t> runaway(
      const std::optional<TelemetryFrame>& before) const {
    if (!before || !is_arm_homed() || !is_homed(*before)) return std::nullopt;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto place = telemetry_->position[j];
      const Steps slack{kJoints[j].max_speed.value / kOvershoot};
      const bool is_above = place > kJointBounds[j].upper + slack && place > before->position[j];
      const bool is_below = place + slack < kJointBounds[j].lower && place < before->position[j];
      if (is_above || is_below) return j;
    }
    return std::nullopt;
  }

  Instant now_{};
  ShippedReceiver receiver_;       ///< what the shipped board would make of the bytes
  Belief shipped_;                 ///< and do
  std::vector<std::byte> recent_;  ///< that may still become part of a window
  Belief strict_;                  ///< what a board would do that finds every window
  int unanswered_ = 0;             ///< frames since the last telemetry
  Splitter splitter_{kTelemetryPayloadSize};
  std::optional<TelemetryFrame> telemetry_;
  bool stands_ = false;  ///< as far as the last two answers tell
  std::optional<std::string> stop_reason_;
  Refusal::Matter matter_of_stop_{};
  std::array<std::byte, kFlushSize + kCommandFrameSize> stop_{};
};

}  // namespace

std::unique_ptr<Judge> make_judge() { return std::make_unique<BoardJudge>(); }

}  // namespace armjig::parol6::rig
