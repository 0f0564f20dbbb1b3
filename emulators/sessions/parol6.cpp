// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "emulators/parol6/can.hpp"
#include "emulators/parol6/plant.hpp"
#include "emulators/sessions/odd_fields.hpp"
#include "emulators/sessions/sessions.hpp"
#include "emulators/sessions/theme.hpp"
#include "harness/core/hex.hpp"
#include "harness/wire/parol6/fields.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::sessions {
namespace {

using namespace armjig::sessions;
using emulation::CanFrame;
using emulation::GripperCan;

struct PassPeriod {
  std::uint16_t weight;
  std::uint32_t us;
};
constexpr auto kPassPeriods = std::to_array<PassPeriod>({{30, 20},
                                                         {8, 10},
                                                         {1, 3},
                                                         {4, 25},
                                                         {4, 37},
                                                         {4, 50},
                                                         {6, 100},
                                                         {4, 130},
                                                         {6, 250},
                                                         {4, 400},
                                                         {4, 1000},
                                                         {2, 2661},
                                                         {2, 20'000}});

class Session : public Draft {
 public:
  using Draft::Draft;

  [[nodiscard]] std::string finish() { return text("parol6", circumstances()); }

  // Frames.
  void jog() {
    CommandFrame frame{.command = Command::kJog};
    for (auto& speed : frame.speed) speed = StepsPerSecond{some_speed()};
    send(frame);
  }
  void stop() { send({.command = Command::kJog}); }
  void go_to() {
    CommandFrame frame{.command = Command::kGoTo};
    const auto reach = dice_.one_in(4) ? 20'000 : 300;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (dice_.one_in(3)) goals_[j] = dice_.number<std::int32_t>(-reach, reach);
      frame.position[j] = Steps{goals_[j]};
      frame.speed[j] = StepsPerSecond{some_speed()};
    }
    send(frame);
  }
  void approach() {  // the goals that there are, so that they are reached
    CommandFrame frame{.command = Command::kGoTo};
    const auto step = dice_.number<std::int32_t>(-20, 20);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      goals_[j] += step;
      frame.position[j] = Steps{goals_[j]};
      frame.speed[j] = StepsPerSecond{dice_.one_in(8) ? 0 : dice_.number<std::int32_t>(1, 4000)};
    }
    send(frame);
  }
  void idle() { send(idle_frame()); }
  void home() { send({.command = Command::kHome}); }
  void demo() { send({.command = Command::kDemo}); }
  void enable() { send({.command = Command::kEnable}); }
  void disable() { send({.command = Command::kDisable}); }
  void clear() { send({.command = Command::kClearError}); }
  void unknown() {
    auto frame = idle_frame();
    frame.command = dice_.number<Command>(0, 255);
    send(frame);
  }
  void grip() {
    auto frame = dice_.one_in(3) ? CommandFrame{.command = Command::kJog} : idle_frame();
    frame.gripper = {.position = dice_.number<std::int16_t>(-1, 256),
                     .speed = dice_.number<std::int16_t>(0, 255),
                     .current = Milliamperes{dice_.number<std::int16_t>(0, 1200)},
                     .command = dice_.number<std::uint8_t>(0, 255),
                     .mode = dice_.number<std::uint8_t>(0, dice_.one_in(5) ? 255 : 2),
                     .id = dice_.number<std::uint8_t>(0, dice_.one_in(3) ? 255 : 3)};
    gripper_ = frame.gripper;
    send(frame);
  }
  void odd_frame() {
    auto bytes = encode(idle_frame());
    for (auto left = dice_.between(1, 4); left > 0; --left) {
      spoil_a_field(dice_, command_fields(), bytes);
    }
    put(bytes);
    pause();
  }
  void again() {  // the last frame, as hosts repeat it
    const auto gap = dice_.between(2'000, 40'000);
    for (auto left = dice_.mostly_low(2, 200); left > 0; --left) {
      put(last_);
      wait(gap);
    }
  }
  void home_on() {  // to the end if nothing comes between
    home();
    last_ = encode(dice_.one_in(6) ? CommandFrame{.command = Command::kHome} : idle_frame());
    hold(dice_.mostly_low(100'000, 40'000'000));
  }
  void demo_on() {  // out, asleep and back, if nothing comes between
    demo();
    hold(dice_.between(1'000'000, 30'000'000));
  }

  // What is no frame.
  void garbage() {
    auto bytes = dice_.bytes(1, dice_.one_in(6) ? 300 : 12);
    for (auto& byte : bytes) {
      if (dice_.one_in(3)) byte = dice_.one_in(2) ? kStartByte : dice_.one_of(kEndBytes);
    }
    put(bytes);
    pause();
  }
  void cut_frame() {
    const auto bytes = encode(idle_frame());
    put(Bytes{bytes}.first(dice_.number<std::size_t>(0, bytes.size() - 1)));
    pause();
  }
  void wrong_length() {  // says a length, and has it or not
    auto bytes = encode(idle_frame());
    std::vector<std::byte> frame(bytes.begin(), bytes.end());
    const auto length =
        dice_.one_in(2) ? dice_.between(0, 255) : dice_.between(0, kCommandPayloadSize);
    frame[kStartSize] = static_cast<std::byte>(length);
    if (!dice_.one_in(3)) {
      frame.resize(kHeaderSize + static_cast<std::size_t>(length), dice_.byte());
      if (length > 2) std::ranges::copy(kEndBytes, frame.end() - std::ssize(kEndBytes));
    }
    put(frame);
    pause();
  }
  void wrong_end() {
    auto bytes = encode(idle_frame());
    bytes[bytes.size() - dice_.number<std::size_t>(1, 2)] = dice_.byte();
    put(bytes);
    pause();
  }
  void burst() {  // frames and garbage that become readable at once
    std::vector<std::byte> all;
    for (auto left = dice_.between(2, 24); left > 0; --left) {
      auto frame = encode(idle_frame());
      frame[kHeaderSize + 36] = static_cast<std::byte>(dice_.one_of(kCodes));
      if (dice_.one_in(3)) spoil_a_field(dice_, command_fields(), frame);
      all.insert(all.end(), frame.begin(), frame.end());
      if (!dice_.one_in(6)) continue;
      const auto noise = dice_.bytes(1, 9);
      all.insert(all.end(), noise.begin(), noise.end());
    }
    add_bytes(all);
    pause();
  }

  // Beside the serial link.
  void answer_can() {
    CanFrame frame{.id = can_id(gripper_.id, GripperCan::kAnswer), .size = 4};
    for (auto& byte : frame.data) byte = dice_.byte();
    if (dice_.one_in(4)) frame.id |= emulation::kCanErrorBit;
    if (dice_.one_in(5)) frame.id = dice_.number<std::uint16_t>(0, 0x7FF);
    if (dice_.one_in(5)) frame.size = dice_.number<std::uint8_t>(0, 8);
    add({R"("dir":"can_to_device","id":{},"hex":"{}")", frame.id, to_hex(frame.payload())});
    pause();
  }
  void input() {
    constexpr std::array<std::string_view, 3> kNames{"estop", "in1", "in2"};
    add({R"("dir":"input","name":"{}","value":{})", dice_.one_of(kNames), dice_.between(0, 1)});
    pause();
  }
  void rest() { wait(dice_.mostly_low(1, 3'000'000)); }

 private:
  static constexpr std::array kCodes{Command::kIdle,      Command::kJog,    Command::kGoTo,
                                     Command::kHome,      Command::kEnable, Command::kDisable,
                                     Command::kClearError};

  [[nodiscard]] CommandFrame idle_frame() {
    CommandFrame frame{.command = Command::kIdle};
    if (dice_.one_in(6)) {
      for (auto& speed : frame.speed) speed = StepsPerSecond{some_speed()};
    }
    return frame;
  }

  [[nodiscard]] std::int32_t some_speed() {
    switch (dice_.between(0, 9)) {
      case 0:
      case 1:
      case 2:
        return 0;
      case 3:
        return dice_.number<std::int32_t>(-20, 20);
      case 4:
        return dice_.number<std::int32_t>(-0x800000, 0x7FFFFF);
      default:
        return dice_.number<std::int32_t>(-20'000, 20'000);
    }
  }

  void send(CommandFrame frame) {
    frame.check = dice_.one_in(4) ? dice_.number<std::uint8_t>(0, 255) : kCheckHost;
    if (dice_.one_in(4)) frame.in_out = dice_.number<std::uint8_t>(0, 255);
    if (dice_.one_in(8)) frame.affected_joints = dice_.number<std::uint8_t>(0, 255);
    if (dice_.one_in(8)) frame.timeout = dice_.number<std::uint8_t>(0, 255);
    if (frame.gripper == GripperSetPoint{}) frame.gripper = gripper_;
    last_ = encode(frame);
    put(last_);
    pause();
  }

  /// At once, in pieces, or byte by byte.
  void put(Bytes bytes) {
    const auto how = dice_.between(0, 15);
    const auto longest = how == 0 ? std::int64_t{1} : how == 1 ? std::int64_t{40} : 100'000;
    const auto gap = how > 1 ? 0 : dice_.mostly_low(0, 5'000);
    while (!bytes.empty()) {
      const auto size =
          std::min(bytes.size(), dice_.number<std::size_t>(longest > 1'000 ? longest : 1, longest));
      add_bytes(bytes.first(size));
      bytes = bytes.subspan(size);
      if (!bytes.empty()) wait(gap);
    }
  }
  void add_bytes(Bytes bytes) { add({R"("dir":"to_device","hex":"{}")", to_hex(bytes)}); }

  /// The last frame again and again.
  void hold(std::int64_t time) {
    const auto end = now_ + time;
    const auto gap = dice_.between(10'000, 90'000);
    while (now_ < end) {
      put(last_);
      wait(gap);
    }
  }
  void pause() {
    switch (dice_.between(0, 7)) {
      case 0:  // nothing between
        return;
      case 1:  // at a pass, or just beside it
        now_ += std::int64_t{period_us_} - now_ % period_us_;
        return wait(dice_.between(0, 2));
      case 2:
        return wait(dice_.between(1, std::int64_t{period_us_} * 3));
      case 3:
        return wait(dice_.mostly_low(1, 500'000));
      default:
        return wait(10'000 + dice_.between(-300, 300));
    }
  }

  [[nodiscard]] std::string circumstances() {
    const auto clock = dice_.between(0, 5);
    const auto micros = clock == 0   ? dice_.between(0, UINT32_MAX)
                        : clock == 1 ? UINT32_MAX - dice_.between(0, 3'000'000)
                        : clock == 2 ? INT32_MAX - dice_.between(0, 3'000'000)
                                     : 740'000;
    const auto bits = dice_.one_in(2) ? 16 : 32;
    const auto timer = dice_.one_in(2) ? 0 : dice_.between(0, (INT64_C(1) << bits) - 1);
    const auto end = now_ + dice_.between(1, 300'000);
    return fmt::format(
        R"("category":"{}","seed":{},"loop_us":{},"duration_us":{},"micros_at_t0":{},)"
        R"("tim2_bits":{},"tim2_at_t0":{},"can_recorded":true,"plant":{})",
        theme_, seed_, period_us_, end, micros, bits, timer, plant());
  }

  [[nodiscard]] std::string plant() {
    std::string joints;
    const auto reach = dice_.one_in(3) ? 8000 : 600;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto limit = emulation::standard_plant().axes[j].limit;
      const bool is_below = limit.side == emulation::LimitSwitch::Side::kAtOrBelow;
      const auto start = dice_.one_in(2) ? 0 : dice_.between(-18'000, 18'000);
      const auto way = dice_.one_in(12) ? dice_.between(-500, 0) : dice_.mostly_low(1, reach);
      joints +=
          fmt::format(R"({}{{"joint":{},"start":{},"threshold":{},"side":"{}","active_level":{}}})",
                      j == 0 ? "" : ",", j + 1, start, is_below ? start - way : start + way,
                      is_below != dice_.one_in(16) ? "<=" : ">=",
                      limit.closed_level == emulation::Level::kHigh ? 1 : 0);
    }
    return Words{R"({{"joints":[{}],"inputs":{{"in1":{},"in2":{},"estop":{}}}}})", joints,
                 dice_.between(0, 1), dice_.between(0, 1), dice_.one_in(5) ? 0 : 1}
        .text;
  }

  std::uint32_t period_us_ = dice_.weighted(kPassPeriods, &PassPeriod::weight).us;
  std::array<std::int32_t, kJointCount> goals_{};
  GripperSetPoint gripper_{};
  CommandBytes last_ = encode(CommandFrame{.command = Command::kIdle});
};

constexpr auto kMotion = std::to_array<Deed<Session>>({{20, &Session::jog},
                                                       {10, &Session::go_to},
                                                       {10, &Session::approach},
                                                       {6, &Session::idle},
                                                       {4, &Session::stop},
                                                       {6, &Session::again},
                                                       {2, &Session::disable},
                                                       {3, &Session::enable},
                                                       {2, &Session::clear},
                                                       {2, &Session::unknown},
                                                       {1, &Session::home},
                                                       {1, &Session::demo},
                                                       {3, &Session::input},
                                                       {2, &Session::odd_frame},
                                                       {4, &Session::rest}});
constexpr auto kGoTo = std::to_array<Deed<Session>>({{6, &Session::go_to},
                                                     {20, &Session::approach},
                                                     {10, &Session::again},
                                                     {1, &Session::jog},
                                                     {1, &Session::idle},
                                                     {4, &Session::rest}});
constexpr auto kHoming = std::to_array<Deed<Session>>({{10, &Session::home_on},
                                                       {2, &Session::home},
                                                       {3, &Session::jog},
                                                       {3, &Session::go_to},
                                                       {4, &Session::idle},
                                                       {2, &Session::disable},
                                                       {3, &Session::enable},
                                                       {2, &Session::clear},
                                                       {1, &Session::unknown},
                                                       {1, &Session::demo},
                                                       {2, &Session::input},
                                                       {3, &Session::rest}});
constexpr auto kDemo = std::to_array<Deed<Session>>({{12, &Session::demo},
                                                     {4, &Session::demo_on},
                                                     {6, &Session::again},
                                                     {4, &Session::approach},
                                                     {3, &Session::go_to},
                                                     {2, &Session::idle},
                                                     {1, &Session::jog},
                                                     {1, &Session::home},
                                                     {10, &Session::rest}});
constexpr auto kGripper = std::to_array<Deed<Session>>({{12, &Session::grip},
                                                        {14, &Session::answer_can},
                                                        {3, &Session::input},
                                                        {2, &Session::idle},
                                                        {2, &Session::enable},
                                                        {3, &Session::again},
                                                        {1, &Session::odd_frame},
                                                        {1, &Session::rest}});
constexpr auto kFraming = std::to_array<Deed<Session>>({{6, &Session::idle},
                                                        {6, &Session::garbage},
                                                        {6, &Session::cut_frame},
                                                        {6, &Session::wrong_length},
                                                        {4, &Session::wrong_end},
                                                        {4, &Session::odd_frame},
                                                        {4, &Session::burst},
                                                        {2, &Session::unknown},
                                                        {1, &Session::rest}});
constexpr auto kStorm = std::to_array<Deed<Session>>({{10, &Session::burst},
                                                      {3, &Session::input},
                                                      {3, &Session::answer_can},
                                                      {2, &Session::garbage},
                                                      {2, &Session::grip},
                                                      {2, &Session::home},
                                                      {2, &Session::jog},
                                                      {2, &Session::odd_frame},
                                                      {1, &Session::wrong_length},
                                                      {1, &Session::rest}});

constexpr auto kThemes =
    std::to_array<Theme<Session>>({{"motion", 10, 500'000, 30'000'000, kMotion},
                                   {"goto", 6, 500'000, 15'000'000, kGoTo},
                                   {"homing", 10, 2'000'000, 60'000'000, kHoming},
                                   {"demo", 5, 1'000'000, 50'000'000, kDemo},
                                   {"gripper", 5, 100'000, 2'000'000, kGripper},
                                   {"framing", 6, 20'000, 3'000'000, kFraming},
                                   {"storm", 4, 50'000, 3'000'000, kStorm}});

}  // namespace

std::string draw(const Roll& roll) { return play<Session>(roll, kThemes); }

}  // namespace armjig::parol6::sessions
