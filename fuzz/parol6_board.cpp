// SPDX-License-Identifier: Apache-2.0
// Two emulated boards get the same treatment. One computes every pass of the main loop, the other
// coasts over passes that repeat themselves. Nobody may be able to tell them apart.
//
// Input: a board to begin with, then operations, each one byte and its arguments. What the input
// does not say is 0.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "emulators/parol6/board.hpp"
#include "fuzz/input.hpp"
#include "fuzz/require.hpp"

namespace armjig::fuzz {
namespace {

using namespace std::chrono_literals;
using parol6::Command;
using parol6::kJointCount;
using parol6::emulation::Board;

/// What one input may cost the board that computes every pass.
constexpr std::int64_t kMostPasses = 6'000;
constexpr int kMostOperations = 60;

constexpr std::array kCodes{Command::kIdle,    Command::kJog,       Command::kGoTo,
                            Command::kHome,    Command::kDemo,      Command::kEnable,
                            Command::kDisable, Command::kClearError};

parol6::CommandBytes command(Command code) {
  parol6::CommandFrame frame;
  frame.command = code;
  return encode(frame);
}

/// A number from -32768 to 32767 that reaches the ends of 24 bits: small ones as they are, large
/// ones on a coarse grid.
std::int32_t stretched(std::int16_t value) noexcept {
  return std::abs(int{value}) < 0x4000 ? value : value * 256;
}

parol6::CommandBytes frame_from(Input& input, const Board& board) {
  parol6::CommandFrame frame;
  const auto code = input.u8();
  frame.command = code < 0xF0 ? kCodes[code % kCodes.size()] : Command{code};
  const auto joints = input.u8();  // which joints get numbers; bit 7: targets near where they are
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if ((joints >> j & 1) == 0) continue;
    frame.speed[j] = StepsPerSecond{stretched(input.i16())};
    frame.position[j] = Steps{stretched(input.i16())};
    if ((joints & 0x80) != 0) {
      const auto offset = frame.position[j].value % 64;
      frame.position[j] = Steps{board.joints()[j].position().value + offset};
    }
  }
  if ((joints & 0x40) != 0) {
    frame.in_out = input.u8();
    frame.gripper.position = input.i16();
    frame.gripper.mode = input.u8() & 3;
    frame.gripper.id = input.u8() & 0x1F;
  }
  return encode(frame);
}

/// A board in the middle of something.
struct Beginning {
  Board board;
  Instant time{};
  std::int64_t period_us{};
};

/// The stages of homing and of the demonstration lie seconds apart, more than an input may take.
std::vector<Beginning> make_prepared() {
  constexpr std::array kHomingTimes{1s, 7s, 10s, 11s, 13s, 16s, 18s, 20s, 22s, 25s, 27s, 31s, 40s};
  constexpr std::array kDemoTimes{1s, 19s, 20s, 22s, 26s, 40s};
  constexpr std::uint32_t kPeriod = 20;
  std::vector<Beginning> boards;
  Board homing{parol6::emulation::standard_plant(),
               {.pass_period = std::chrono::microseconds{kPeriod}}};
  homing.receive(at(0s), command(Command::kHome));
  homing.receive(at(10ms), command(Command::kIdle));
  for (const auto time : kHomingTimes) {
    homing.advance_to(at(time));
    homing.clear_sent();
    boards.push_back({homing, at(time), kPeriod});
  }
  Board demo{parol6::emulation::standard_plant(),
             {.pass_period = std::chrono::microseconds{kPeriod}}};
  demo.receive(at(0s), command(Command::kDemo));
  for (const auto time : kDemoTimes) {
    demo.advance_to(at(time));
    demo.clear_sent();
    boards.push_back({demo, at(time), kPeriod});
  }
  return boards;
}

Beginning fresh_board(Input& input) {
  constexpr std::array<std::uint32_t, 8> kPeriods{20, 10, 1, 7, 37, 50, 100, 1000};
  parol6::emulation::BoardTiming timing;
  const auto clocks = input.u8();
  timing.pass_period = std::chrono::microseconds{kPeriods[clocks & 7]};
  if ((clocks & 0x08) != 0) timing.micros_at_start = UINT32_MAX - 20'000;  // wraps soon
  if ((clocks & 0x10) != 0) timing.timer_bits = 32;
  if ((clocks & 0x20) != 0) timing.timer_at_start = Ticks{65'000};
  auto plant = parol6::emulation::standard_plant();
  for (auto& axis : plant.axes) {
    axis.position = Steps{0};
    axis.limit.threshold = Steps{static_cast<std::int8_t>(input.u8())};
    if ((clocks & 0x40) != 0) axis.limit.side = parol6::emulation::LimitSwitch::Side::kAtOrAbove;
  }
  return {Board{plant, timing}, at(0s), static_cast<std::uint32_t>(timing.pass_period.count())};
}

/// Otherwise a fresh one with a plant and clocks of the input's choice.
Beginning beginning_from(Input& input) {
  static const auto prepared = make_prepared();
  const auto choice = input.u8();
  return choice < prepared.size() ? prepared[choice] : fresh_board(input);
}

class Pair {
 public:
  Pair(const Board& board, Instant time) : fast_{board}, plain_{board}, time_{time} {
    plain_.use_plain_loop();
  }

  template <class Operation>
  void both(Operation operation) {
    operation(fast_);
    operation(plain_);
    compare();
  }

  void wait(Duration duration) {
    time_ += duration;
    both([this](Board& board) { board.advance_to(time_); });
  }

  [[nodiscard]] Instant time() const noexcept { return time_; }
  [[nodiscard]] const Board& fast() const noexcept { return fast_; }

 private:
  void compare() {
    const auto is_same = [](const parol6::emulation::Emission& a,
                            const parol6::emulation::Emission& b) {
      return a.time == b.time && a.what == b.what;
    };
    require(std::ranges::equal(fast_.sent(), plain_.sent(), is_same), "both send the same");
    require(fast_.next_event() == plain_.next_event(), "both expect the same");
    require(fast_.plant() == plain_.plant(), "both leave the same surroundings");
    require(fast_.homing() == plain_.homing(), "both are in the same stage of homing");
    require(fast_.is_enabled() == plain_.is_enabled(), "both are enabled or both are not");
    for (std::size_t j = 0; j < kJointCount; ++j) {
      require(fast_.joints()[j].stepper == plain_.joints()[j].stepper, "both step the same");
    }
    fast_.clear_sent();
    plain_.clear_sent();
  }

  Board fast_;
  Board plain_;
  Instant time_;
};

void touch(Input& input, Pair& pair) {
  const auto what = input.u8();
  const auto j = static_cast<std::size_t>(what >> 3) % kJointCount;
  const auto shift = input.i16();
  pair.both([&](Board& board) {
    board.touch(pair.time(), [&](parol6::emulation::Plant& plant) {
      auto& axis = plant.axes[j];
      switch (what & 7) {
        case 0:
          plant.inputs.estop = opposite(plant.inputs.estop);
          break;
        case 1:
          plant.inputs.in1 = opposite(plant.inputs.in1);
          break;
        case 2:
          axis.switch_state = parol6::emulation::Axis::SwitchState::kStuckClosed;
          break;
        case 3:
          axis.switch_state = parol6::emulation::Axis::SwitchState::kStuckOpen;
          break;
        case 4:
          axis.switch_state = parol6::emulation::Axis::SwitchState::kWorking;
          break;
        case 5:
          axis.is_jammed = !axis.is_jammed;
          break;
        case 6:  // the switch is about to change, or changes now
          axis.limit.threshold = axis.position + Steps{shift % 64};
          break;
        default:
          axis.position = axis.position + Steps{shift};
          break;
      }
    });
  });
}

void operate(Input& input, Pair& pair, const Beginning& start) {
  switch (input.u8() % 8) {
    case 0:
    case 1: {
      const auto frame = frame_from(input, pair.fast());
      pair.both([&](Board& board) { board.receive(pair.time(), frame); });
      break;
    }
    case 2:  // some passes
      pair.wait(std::chrono::microseconds{start.period_us * input.u8()});
      break;
    case 3:  // many passes
      pair.wait(std::chrono::microseconds{start.period_us * 16 * input.u8()});
      break;
    case 4: {  // any bytes, also half frames
      const auto bytes = input.bytes(input.u8() % 64U);
      pair.both([&](Board& board) { board.receive(pair.time(), bytes); });
      break;
    }
    case 5:
      touch(input, pair);
      break;
    case 6: {
      parol6::emulation::CanFrame frame;
      frame.id = static_cast<std::uint16_t>(input.i16() & 0x7FF);
      frame.size = input.u8() % 9;
      for (auto& byte : frame.data) byte = static_cast<std::byte>(input.u8());
      pair.both([&](Board& board) { board.receive_can(pair.time(), frame); });
      break;
    }
    default:  // off the grid of passes, or a reboot
      pair.wait(std::chrono::nanoseconds{input.u8()});
      if (input.u8() == 0xAA) pair.both([&](Board& board) { board.reboot(pair.time()); });
      break;
  }
}

void check_boards(Input input) {
  const auto start = beginning_from(input);
  Pair pair{start.board, start.time};
  const auto latest = start.time + std::chrono::microseconds{start.period_us * kMostPasses};
  for (int i = 0; i < kMostOperations && !input.is_empty() && pair.time() < latest; ++i) {
    operate(input, pair, start);
  }
  pair.wait(std::chrono::microseconds{start.period_us * 500});
}

}  // namespace
}  // namespace armjig::fuzz

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::check_boards(armjig::fuzz::Input{std::as_bytes(std::span{data, size})});
  return 0;
}
