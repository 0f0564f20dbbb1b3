// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/emulators/parol6/session.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "tests/unit/support/bytes.hpp"

namespace armjig::parol6::emulation {
namespace {

using test::ByteVector;
using test::Dice;
using test::joined;
using namespace std::chrono_literals;

template <class Value, std::size_t Size>
Value one_of(Dice& dice, const std::array<Value, Size>& values) {
  return values[static_cast<std::size_t>(dice.between(0, Size - 1))];
}

std::int32_t number(Dice& dice, std::int64_t least, std::int64_t most) {
  return static_cast<std::int32_t>(dice.between(least, most));
}

BoardTiming random_timing(Dice& dice) {
  constexpr std::array<std::uint32_t, 8> kPasses{10, 20, 20, 20, 25, 37, 50, 100};
  BoardTiming timing;
  timing.pass_period = std::chrono::microseconds{one_of(dice, kPasses)};
  // Half of the sessions see the microsecond clock wrap.
  timing.micros_at_start = dice.one_in(2) ? static_cast<std::uint32_t>(-dice.between(1, 30'000'000))
                                          : static_cast<std::uint32_t>(dice.between(0, 1'000'000));
  timing.timer_at_start = Ticks{static_cast<std::uint32_t>(dice.between(0, UINT32_MAX))};
  timing.timer_bits = dice.one_in(2) ? 16 : 32;
  return timing;
}

Plant random_plant(Dice& dice, bool is_gentle) {
  auto plant = standard_plant();
  for (auto& axis : plant.axes) {
    const bool is_below = axis.limit.side == LimitSwitch::Side::kAtOrBelow;
    const auto distance = number(dice, dice.one_in(8) ? -500 : 1, 3000);
    axis.position = Steps{number(dice, -5000, 5000)};
    axis.limit.threshold = axis.position + Steps{is_below ? -distance : distance};
    const bool is_wired_wrong = !is_gentle && dice.one_in(20);
    if (is_wired_wrong) axis.limit.closed_level = opposite(axis.limit.closed_level);
    if (dice.one_in(20)) axis.limit.closed_level = opposite(axis.limit.closed_level);
  }
  return plant;
}

std::int32_t random_speed(Dice& dice) {
  constexpr std::array<std::int32_t, 6> kHomingSpeeds{-2050, 2050, -750, -2550, 4050, -8050};
  switch (dice.between(0, 7)) {
    case 0:
      return 0;
    case 1:
      return number(dice, -9, 9);
    case 2:
    case 3:
      return number(dice, -300, 300);
    case 4:
    case 5:
      return number(dice, -9000, 9000);
    case 6:
      return one_of(dice, kHomingSpeeds);
    default:
      return number(dice, -8'388'608, 8'388'607);
  }
}

std::int32_t random_position(Dice& dice) {
  constexpr std::array<std::int32_t, 8> kHomingTargets{850,  1050,  -1550, 1550,
                                                       8900, 13500, 15900, -10200};
  switch (dice.between(0, 5)) {
    case 0:
      return number(dice, -3, 3);
    case 1:
    case 2:
      return number(dice, -300, 300);
    case 3:
      return number(dice, -20'000, 20'000);
    case 4:
      return one_of(dice, kHomingTargets);
    default:
      return dice.one_in(4) ? number(dice, -8'388'608, 8'388'607) : 0;
  }
}

Command random_command(Dice& dice, Command last) {
  // Homing goes on with idle frames.
  if (last == Command::kHome && dice.between(1, 10) <= 8) return Command::kIdle;
  constexpr std::array kCommands{
      Command::kHome,    Command::kHome,       Command::kHome, Command::kIdle,   Command::kIdle,
      Command::kIdle,    Command::kIdle,       Command::kJog,  Command::kJog,    Command::kJog,
      Command::kGoTo,    Command::kGoTo,       Command::kGoTo, Command::kEnable, Command::kEnable,
      Command::kDisable, Command::kClearError, Command::kDemo, Command{42}};
  return one_of(dice, kCommands);
}

/// How long the last thing goes on.
Duration random_pause(Dice& dice) {
  switch (dice.between(0, 9)) {
    case 0:
      return 0us;
    case 1:
    case 2:
      return std::chrono::microseconds{dice.between(1, 300)};
    case 3:
    case 4:
      return std::chrono::nanoseconds{dice.between(1, 20'000'000)};
    case 5:
    case 6:
    case 7:
      return std::chrono::milliseconds{dice.between(5, 700)};
    case 8:
      return std::chrono::milliseconds{dice.between(500, 3000)};
    default:
      return std::chrono::milliseconds{dice.between(2000, 15'000)};
  }
}

class Author {
 public:
  Author(std::uint64_t seed, Duration length)
      : dice_{seed}, length_{length}, is_gentle_{dice_.between(1, 3) <= 2} {
    session_.timing = random_timing(dice_);
    session_.plant = random_plant(dice_, is_gentle_);
  }

  Session write() {
    while (now_ < length_) {
      add_action();
      const bool lets_home =
          (last_ == Command::kIdle || last_ == Command::kHome) && dice_.one_in(8);
      now_ += lets_home ? Duration{std::chrono::milliseconds{dice_.between(5000, 20'000)}}
                        : random_pause(dice_);
    }
    session_.end = at(length_);
    return std::move(session_);
  }

 private:
  void add(std::string what, std::function<void(Board&)> act) {
    session_.actions.push_back({at(now_), std::move(what), std::move(act)});
  }

  void add_action() {
    const auto choice = dice_.between(1, 100);
    if (choice <= 6) return add_long_run();
    if (choice <= 70) return add_frames();
    if (choice <= 78) return add_noise();
    if (choice <= 86) return add_can();
    if (choice <= 98) return add_touch();
    add("reboot", [time = at(now_)](Board& board) { board.reboot(time); });
  }

  CommandFrame random_frame() {
    CommandFrame frame;
    frame.command = last_ = random_command(dice_, last_);
    // Often all joints do the same kind of thing, or none but one.
    const bool only_one = dice_.one_in(3);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const bool is_still = only_one && !dice_.one_in(6);
      frame.position[j] = Steps{is_still ? 0 : random_position(dice_)};
      frame.speed[j] = StepsPerSecond{is_still ? 0 : random_speed(dice_)};
    }
    frame.in_out = std::to_integer<std::uint8_t>(dice_.byte());
    frame.gripper.position = static_cast<std::int16_t>(dice_.between(0, 2));
    frame.gripper.mode = static_cast<std::uint8_t>(dice_.one_in(3) ? dice_.between(1, 3) : 0);
    frame.gripper.id = static_cast<std::uint8_t>(dice_.between(0, 1));
    return frame;
  }

  /// Homing or the demonstration, left alone for long enough to get to any stage.
  void add_long_run() {
    const auto code = dice_.one_in(3) ? Command::kDemo : Command::kHome;
    for (const auto each : {Command::kEnable, Command::kIdle, code, Command::kIdle}) {
      if (code == Command::kDemo && each == Command::kIdle && last_ == code) break;
      CommandFrame frame;
      frame.command = last_ = each;
      add("long run",
          [time = at(now_), bytes = encode(frame)](Board& board) { board.receive(time, bytes); });
      now_ += 10ms;
    }
    now_ += std::chrono::milliseconds{dice_.between(2000, 35'000)};
  }

  void add_frames() {
    ByteVector bytes;
    std::string codes;
    for (auto frames = dice_.one_in(6) ? dice_.between(2, 4) : 1; frames > 0; --frames) {
      const auto frame = random_frame();
      codes.append(" ").append(std::to_string(static_cast<int>(frame.command)));
      bytes = joined(std::move(bytes), test::as_vector(encode(frame)));
    }
    if (dice_.one_in(20)) bytes.resize(static_cast<std::size_t>(dice_.between(1, 60)));
    add("frames" + codes, [time = at(now_), bytes](Board& board) { board.receive(time, bytes); });
  }

  void add_noise() {
    ByteVector bytes;
    for (auto size = dice_.between(1, 40); size > 0; --size) {
      bytes.push_back(dice_.one_in(4) ? kStartByte : dice_.byte());
    }
    if (dice_.one_in(3)) bytes = test::hex("FF FF FF 02 01 02");
    add("noise", [time = at(now_), bytes](Board& board) { board.receive(time, bytes); });
  }

  void add_can() {
    std::vector<CanFrame> frames(static_cast<std::size_t>(dice_.between(1, 3)));
    for (auto& frame : frames) {
      frame.id = can_id(static_cast<std::uint8_t>(dice_.between(0, 1)), GripperCan::kAnswer);
      frame.size = static_cast<std::uint8_t>(dice_.one_in(5) ? dice_.between(0, 8) : 4);
      for (auto& byte : frame.data) byte = dice_.byte();
    }
    add("can", [time = at(now_), frames](Board& board) {
      for (const auto& frame : frames) board.receive_can(time, frame);
    });
  }

  void add_touch() {
    const auto j = static_cast<std::size_t>(dice_.between(0, kJointCount - 1));
    const auto kind = dice_.between(0, is_gentle_ ? 3 : 6);
    const auto distance = Steps{number(dice_, -2000, 2000)};
    const auto state = static_cast<Axis::SwitchState>(dice_.one_in(2) ? 0 : dice_.between(1, 2));
    add("touch", [time = at(now_), j, kind, distance, state](Board& board) {
      board.touch(time, [&](Plant& plant) {
        auto& axis = plant.axes[j];
        auto& inputs = plant.inputs;
        if (kind == 0) inputs.estop = opposite(inputs.estop);
        if (kind == 1) inputs.in1 = opposite(inputs.in1);
        if (kind == 2) inputs.in2 = opposite(inputs.in2);
        if (kind == 3) axis.position = axis.position + distance;
        if (kind == 4 || kind == 5) axis.switch_state = state;
        if (kind == 6) axis.is_jammed = !axis.is_jammed;
      });
    });
  }

  Dice dice_;
  Duration length_;
  bool is_gentle_;  ///< nobody breaks the arm
  Duration now_{};
  Command last_{};
  Session session_;
};

}  // namespace

Session random_session(std::uint64_t seed, Duration length) { return Author{seed, length}.write(); }

}  // namespace armjig::parol6::emulation
