// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/board_bench.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>
#include <vector>

#include "harness/core/hex.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/fields.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::conformance {
namespace {

using namespace std::chrono_literals;

/// Homing takes 31 s where the switches are near.
constexpr Duration kHomingTime = 90s;
/// So long an emergency stop may take to be released.
constexpr Duration kReleaseTime = 200ms;
constexpr std::string_view kLayout = "60 bytes FF FF FF 38 ... 01 02";

const Field& telemetry_field(std::string_view name) {
  return *find_field(telemetry_fields(), name);
}

}  // namespace

bool is_without_gap(std::span<const Answer> answers) noexcept {
  return std::ranges::adjacent_find(answers, [](const Answer& before, const Answer& after) {
           return after.asked - before.received > std::chrono::milliseconds{100};
         }) == answers.end();
}

CommandFrame with_code(int code) { return with_code(Command{static_cast<std::uint8_t>(code)}); }
CommandFrame with_code(Command code) {
  CommandFrame frame;
  frame.command = code;
  return frame;
}

CommandFrame idle() { return with_code(Command::kIdle); }

CommandFrame with_speeds(int code, const Speeds& speeds) {
  auto frame = with_code(code);
  std::ranges::transform(speeds, frame.speed.begin(),
                         [](int speed) { return StepsPerSecond{speed}; });
  return frame;
}

CommandFrame jog(const Speeds& speeds) { return with_speeds(123, speeds); }

CommandFrame jog(std::size_t joint, int speed) {
  Speeds speeds{};
  speeds[joint] = speed;
  return jog(speeds);
}

CommandFrame go_to(const std::array<Steps, kJointCount>& positions, const Speeds& speeds) {
  auto frame = with_speeds(156, speeds);
  frame.position = positions;
  return frame;
}

CommandFrame with_gripper(const GripperSetPoint& set_point) {
  auto frame = idle();
  frame.gripper = set_point;
  return frame;
}

BoardBench::BoardBench(Rig<StreamPort> rig) : StreamBench{std::move(rig), make_dissector()} {}

Duration BoardBench::answer_time() const { return std::max<Duration>(1s, 20 * noise()); }
Duration BoardBench::silence_time() const { return std::max<Duration>(50ms, 5 * noise()); }

std::optional<Answer> BoardBench::next_answer(Instant asked, Duration within) {
  const auto message = receive(within);
  if (!message) return std::nullopt;
  if (!message->fault.empty()) {
    not_understood_ = fmt::format("{} ({})", to_hex_dump(message->raw), message->fault);
    return std::nullopt;
  }
  const auto raw = Bytes{message->raw}.first<kTelemetryFrameSize>();
  Answer answer{{decode_telemetry(body_of(raw))}, {}, asked, message->time};
  std::ranges::copy(raw, answer.raw.begin());
  return answer;
}

/// Not sooner than a millisecond behind the answer before: the board writes its CAN frames to one
/// mailbox and loses what comes while that is full.
Answer BoardBench::ask(const CommandFrame& frame, Duration within) {
  pause(last_answered_ + 1ms - now());
  const auto asked = now();
  not_understood_.clear();
  send(encode(frame));
  const auto answer = next_answer(asked, within);
  last_answered_ = now();
  if (!answer) {
    fail_to_understand();
    fail_if_late(asked, within);
    fail_by_silence(in_context("an answer"),
                    fmt::format("none within {:.0f} ms", milliseconds(within)));
  }
  return answer.value_or(Answer{});
}

/// An answer that comes after all is a matter of time, as on a link that was held up.
void BoardBench::fail_if_late(Instant asked, Duration within) {
  constexpr Duration kLate = 2s;
  const auto answer = next_answer(asked, kLate);
  if (!answer) return;
  const auto time = milliseconds(answer->received - asked);
  expect_in_time({time, 0, milliseconds(within), "ms"}, "an answer",
                 fmt::format("one after {:.0f} ms", time));
}

/// A finding if something came that is no answer.
void BoardBench::fail_to_understand() {
  if (!not_understood_.empty()) fail(in_context(kLayout), std::exchange(not_understood_, {}));
}

std::vector<Answer> BoardBench::ask_together(const std::vector<CommandFrame>& frames) {
  std::vector<std::byte> bytes;
  for (const auto& frame : frames) {
    const auto one = encode(frame);
    bytes.insert(bytes.end(), one.begin(), one.end());
  }
  send(bytes);
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < frames.size(); ++i) answers.push_back(expect_answer());
  return answers;
}

Answer BoardBench::act(const CommandFrame& frame) {
  auto answer = ask(frame);
  pause(kPassTime);
  return answer;
}

Answer BoardBench::keep_asking(const CommandFrame& frame, Duration time) {
  const auto end = now() + time;
  auto answer = ask(frame);
  while (!is_over() && !error() && now() < end) {
    pause(std::min(kFramePeriod, end - now()));
    answer = ask(frame);
  }
  return answer;
}

Answer BoardBench::expect_answer() {
  const auto asked = now();
  not_understood_.clear();
  const auto answer = next_answer(asked, answer_time());
  if (!answer) {
    fail_to_understand();
    fail_if_late(asked, answer_time());
    fail(in_context("an answer"),
         fmt::format("none within {:.0f} ms", milliseconds(answer_time())));
  }
  return answer.value_or(Answer{});
}

void BoardBench::expect_silence() {
  const auto message = receive(silence_time());
  if (message) fail(in_context("no answer"), to_hex_dump(message->raw));
}

void BoardBench::expect_whole() {
  send(encode(idle()));
  const auto message = receive(answer_time());
  if (!message) return fail_by_silence("a telemetry frame", "silence");
  if (!message->fault.empty()) fail(std::string{kLayout}, message->fault);
}

void BoardBench::expect_recovery(int most) {
  for (int i = 0; i < most && !is_over() && !error(); ++i) {
    send(encode(idle()));
    if (!next_answer(now(), silence_time())) continue;
    drain(silence_time());
    return;
  }
  if (next_answer(now(), answer_time())) {  // late, as on a machine that has no time
    drain(silence_time());
    return;
  }
  fail(in_context(fmt::format("an answer within {} good frames", most)), "silence");
}

void BoardBench::expect(const Answer& answer, std::string_view field, std::int64_t wanted) {
  expect_between(answer, field, wanted, wanted);
}

void BoardBench::expect_bits(const Answer& answer, std::string_view field, std::uint8_t mask,
                             std::uint8_t wanted) {
  const auto value = field_value(telemetry_field(field), answer.raw);
  expect(answer, field, (value & ~std::int64_t{mask}) | wanted);
}

void BoardBench::expect_same(const Answer& answer, std::string_view field, const Answer& before) {
  expect(answer, field, field_value(telemetry_field(field), before.raw));
}

void BoardBench::expect_between(const Answer& answer, std::string_view name, std::int64_t least,
                                std::int64_t most) {
  if (is_over()) return;
  const auto& field = telemetry_field(name);
  const auto value = field_value(field, answer.raw);
  if (value >= least && value <= most) return;
  const auto wanted = least == most
                          ? sentence_of(field, least)
                          : fmt::format("{} = {} to {}", name, least, field_text(field, most));
  fail(in_context(wanted), sentence_of(field, value));
}

/// Asks until the board answers, for it may wait for the rest of what it took for a long frame.
bool BoardBench::is_alive() {
  constexpr int kMostTries = 12;
  drain(10ms);
  not_understood_.clear();
  for (int i = 0; i < kMostTries && !error(); ++i) {
    send(encode(idle()));
    if (!next_answer(now(), i == 0 ? answer_time() : silence_time())) continue;
    drain(10ms);
    return true;
  }
  if (not_understood_.empty() && !error()) {
    // What never becomes a frame stays with who looks for frames.
    std::vector<std::byte> bytes;
    std::array<std::byte, kTelemetryFrameSize> buffer{};
    send(encode(idle()));
    for (const auto end = now() + answer_time(); bytes.size() < buffer.size() && now() < end;) {
      const auto size = port().read(buffer, end);
      if (!size) break;
      bytes.insert(bytes.end(), buffer.begin(),
                   buffer.begin() + static_cast<std::ptrdiff_t>(*size));
    }
    if (!bytes.empty()) not_understood_ = to_hex_dump(bytes);
  }
  fail_to_understand();
  return false;
}

void BoardBench::measure_noise() {
  constexpr int kSamples = 40;
  for (int i = 0; i < kSamples && !error(); ++i) {
    pause(1000us + i * 37us);
    const auto asked = now();
    send(encode(idle()));
    if (const auto answer = next_answer(asked, answer_time())) {
      hear_noise(answer->received - asked);
    }
  }
}

void BoardBench::bring_to(std::size_t start) {
  if (std::exchange(is_spoiled_, false) || start == kFresh) power_cycle();
  if (start == kFresh) return;  // its first answer is for the case
  if (!is_alive()) fail_by_silence("an answer", "silence");
  if (start == kHomed || start == kEnabled) enable();
  if (start == kHomed) home();
  if (start == kEnabled) walk_back();
}

void BoardBench::spoil() {
  touch("in1", 0);  // as it is anyway; it shows whether there is a hand
  is_spoiled_ = is_spoiled_ || !is_over();
}

void BoardBench::spoil_memory() {
  if (!has_switch()) miss_hand("power");
  is_spoiled_ = is_spoiled_ || !is_over();
}

/// Of its power; each emulated one has it.
bool BoardBench::has_switch() { return !rig().is_guarded() || hand().has("power"); }

bool BoardBench::revive() {
  if (!has_switch()) return false;
  power_cycle();
  return is_alive();
}

void BoardBench::power_cycle() {
  if (reach("in1", 0)) put_back_surroundings();
  touch("power", 1);
  pause(1s);
  drain(10ms);  // what the case before left unread is no answer to the next one
  origin_.reset();
}

void BoardBench::put_back_surroundings() {
  struct Input {
    std::string_view name;
    std::int64_t value;
  };
  for (const auto& [name, value] :
       {Input{"estop", 1}, {"in1", 0}, {"in2", 0}, {"between-fingers", -1}}) {
    touch(name, value);
  }
  constexpr int kBesideSwitch = 1000;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    touch(fmt::format("switch.j{}", j + 1), 0);
    touch(fmt::format("position.j{}", j + 1),
          kStandby[j].value + (j + 1 == kJointCount ? kBesideSwitch : 0));
  }
}

Answer BoardBench::say_enable() {
  act(with_code(101));
  act(idle());
  return act(idle());
}

void BoardBench::enable() {
  auto answer = say_enable();
  if (is_estop_pressed(answer)) {
    if (!reach("estop", 1)) {
      blame_rig("the emergency stop is pressed, or reads inverted");
    } else {
      pause(kReleaseTime);
      answer = say_enable();
      expect_true(!is_estop_pressed(answer), "an emergency stop that was released to read released",
                  "it is pressed, or reads inverted");
    }
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    expect(answer, fmt::format("speed.j{}", j + 1), 0);
  }
}

/// Cases drive unhomed joints to and fro; what remains must not add up until a switch is hit. One
/// that homed the arm put its counters elsewhere.
void BoardBench::walk_back() {
  constexpr int kNear = 20;
  constexpr int kMost = 1500;  // what a guard lets pass for every joint
  auto answer = ask(idle());
  if (is_homed(answer)) origin_ = kStandby;
  if (!origin_) origin_ = answer.position;
  const auto is_back = [&](const Answer& now) {
    return std::ranges::equal(now.position, *origin_, [](Steps a, Steps b) {
      return std::abs(a.value - b.value) <= kNear;
    });
  };
  const auto end = now() + 20s;
  while (!is_back(answer) && !is_over() && !error() && now() < end) {
    Speeds speeds{};
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto way = (*origin_)[j].value - answer.position[j].value;
      if (std::abs(way) > kNear) speeds[j] = std::clamp(way * 8, -kMost, kMost);
    }
    answer = ask(jog(speeds));
    pause(kFramePeriod);
  }
  act(idle());
}

/// J6 rests at its switch, where its first seek could not be seen.
void BoardBench::leave_switch() {
  Speeds speeds{};
  speeds.back() = 1500;
  keep_asking(jog(speeds), 700ms);
  act(idle());
}

/// Homes once even if the arm is homed, for cases look at how it went; and again if this machine
/// did not look all the time, unless it never does.
void BoardBench::home() {
  constexpr int kMostHomings = 3;
  for (int i = 0; i < kMostHomings && !has_seen_homing_ && !is_over() && !error(); ++i) {
    home_once();
    has_seen_homing_ = is_without_gap(homing_log_) || i + 1 == kMostHomings;
  }
  if (!is_homed(ask(idle()))) home_once();
  walk_to_standby();
}

/// A 100 only once, then idle frames: a 100 that is held homes again and again. One that was seen
/// all the time is not forgotten for one that was not.
void BoardBench::home_once() {
  leave_switch();
  std::vector<Answer> log{ask(idle())};
  act(with_code(100));
  const auto finished = ask_until(
      idle(),
      [&log](const Answer& answer) {
        log.push_back(answer);
        return is_homed(answer);
      },
      kHomingTime);
  if (!finished && !error()) {
    fail("all joints homed within 90 s",
         sentence_of(telemetry_field("homed"), log.back().homed) + "; are arm and switches there?");
  }
  const bool is_kept = homing_log_.empty() || is_without_gap(log) || !is_without_gap(homing_log_);
  if (is_kept) homing_log_ = std::move(log);
  origin_ = kStandby;
  act(idle());
}

/// The board would close any distance in 10 ms if it could. Each piece is counted from the one
/// before and not from where the arm is, so that an arm that goes elsewhere is seen to stray. At
/// the speeds that the demonstration leaves as the most, a board with passes of 250 us steps in
/// every second one: 2000 steps/s.
void BoardBench::walk_to_standby() {
  constexpr int kPiece = 15;
  constexpr int kMostPieces = 20'000;
  auto position = ask(idle()).position;
  auto target = position;
  for (int i = 0; i < kMostPieces && position != kStandby && !is_over() && !error(); ++i) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      target[j].value += std::clamp(kStandby[j].value - target[j].value, -kPiece, kPiece);
    }
    position = ask(go_to(target)).position;
    pause(kFramePeriod);
  }
  act(idle());
}

}  // namespace armjig::parol6::conformance
