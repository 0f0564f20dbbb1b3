// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/node_bench.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "conformance/morap/laws.hpp"
#include "harness/core/hex.hpp"
#include "harness/wire/morap/dissector.hpp"

namespace armjig::morap::conformance {
namespace {

using namespace std::chrono_literals;
using enum CommandId;

/// Behind a tick; no transaction is as short.
constexpr Duration kMargin = 20us;
/// Messages begin with the byte of the address.
constexpr std::size_t kAddressSize = 1;

/// So long a shaft may coast.
constexpr Duration kRestTime = 5s;

std::vector<std::byte> bytes_of(std::string_view hex) { return *from_hex(hex); }

/// As the document has numbers, IEEE 754 with the low byte first; not as our codec has them.
std::array<std::byte, 4> bytes_of(float value) noexcept {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return {static_cast<std::byte>(bits), static_cast<std::byte>(bits >> 8U),
          static_cast<std::byte>(bits >> 16U), static_cast<std::byte>(bits >> 24U)};
}

std::string name_of_selector(CommandId selector) {
  const auto* reading = find_reading(selector);
  return reading == nullptr ? "a reading" : std::string{reading->name};
}

}  // namespace

NodeBench::NodeBench(Rig<BusPort> rig, const Subject& subject)
    : BusBench{std::move(rig), make_dissector()}, subject_{subject} {}

NodeBench::~NodeBench() { put_sets_back(); }

// ---- Writing and reading

void NodeBench::send(const Command& command) { send_bytes(encode(command)); }

void NodeBench::tune(TuneKind kind, float inertia, float pole) {
  send(Command{kTune, TuneRequest{kind, inertia, pole}});
}

void NodeBench::send_bytes(std::string_view hex, End end) { send_bytes(bytes_of(hex), end); }

void NodeBench::send_bytes(Bytes bytes, End end) {
  if (is_deaf()) return;
  const auto written = write(subject_.address, bytes, end);
  keep_pace();
  if (error()) return;
  if (!written.is_addressed) {
    fail_by_silence(in_context("the address to be acknowledged"), "it was not");
  } else if (written.refused > 0) {
    fail(in_context("all bytes to be acknowledged"),
         fmt::format("{} of {} were not", written.refused, bytes.size()));
  }
}

std::vector<std::byte> NodeBench::read_on(std::size_t size) {
  auto bytes = BusBench::read(subject_.address, size);
  keep_pace();
  if (!bytes && !is_deaf()) {
    fail_by_silence(in_context("the address to be acknowledged for a read"), "it was not");
  }
  return bytes.value_or(std::vector<std::byte>(size));
}

std::vector<std::byte> NodeBench::read(CommandId selector, std::size_t size) {
  send(selector);
  return read_on(size);
}

float NodeBench::number(CommandId selector) {
  return decode_float(slice<4>(Bytes{read(selector, 4)}, 0));
}

// ---- Expecting

void NodeBench::expect_same(Bytes actual, Bytes wanted) {
  if (std::ranges::equal(actual, wanted)) return;
  fail(in_context(to_hex_dump(wanted)), to_hex_dump(actual));
}

/// What was just read.
void NodeBench::expect_read(Bytes actual, Bytes wanted) {
  if (std::ranges::equal(actual, wanted)) return;
  const auto differs = std::ranges::mismatch(actual, wanted).in1 - actual.begin();
  fail_at(kAddressSize + static_cast<std::size_t>(differs), in_context(to_hex_dump(wanted)),
          to_hex_dump(actual));
}

void NodeBench::expect_bytes(CommandId selector, std::string_view hex) {
  const auto wanted = bytes_of(hex);
  expect_read(read(selector, wanted.size()), wanted);
}

void NodeBench::expect_read_on(std::string_view hex) {
  const auto wanted = bytes_of(hex);
  expect_read(read_on(wanted.size()), wanted);
}

void NodeBench::expect_number(CommandId selector, float wanted) {
  const auto actual = read(selector, 4);
  if (std::ranges::equal(actual, bytes_of(wanted))) return;
  fail_at(kAddressSize, in_context(fmt::format("{} {}", name_of_selector(selector), wanted)),
          fmt::format("{}", decode_float(slice<4>(Bytes{actual}, 0))));
}

void NodeBench::expect_near(CommandId selector, double wanted, double tolerance) {
  const auto actual = static_cast<double>(number(selector));
  if (std::fabs(actual - wanted) <= tolerance) return;
  fail_at(kAddressSize,
          in_context(fmt::format("{} {} within {}", name_of_selector(selector), wanted, tolerance)),
          fmt::format("{}", actual));
}

void NodeBench::expect_state(CommandId selector, std::string_view name, int wanted) {
  const auto actual = std::to_integer<int>(read(selector, 1)[0]);
  if (actual == wanted) return;
  fail_at(kAddressSize, in_context(fmt::format("{} {}", name, wanted)), fmt::format("{}", actual));
}

void NodeBench::expect_status(MotorStatus wanted) {
  expect_state(kReadMotorStatus, "motor status", static_cast<int>(wanted));
}

void NodeBench::expect_programming(ProgrammingStatus wanted) {
  expect_state(kReadProgrammingStatus, "programming status", static_cast<int>(wanted));
}

void NodeBench::expect_absent(BusAddress address) {
  if (is_deaf()) return;
  const auto written = write(address, {});
  if (written.is_addressed) {
    fail(in_context(fmt::format("no acknowledgement of address {:02X}", address.value)), "one");
  }
}

// ---- Time

void NodeBench::settle() { pause(12ms + noise()); }

void NodeBench::tick(std::uint16_t rate_hz) {
  if (is_deaf()) return;
  if (!is_slow_ && !subject_.is_exact) return skip("needs time to stand still at its ticks");
  const auto before = tick_period(rate_hz_);
  // When a node idles that nobody has switched on, its next tick comes within a period.
  if (is_slow_ && rate_hz_ == kIdleRateHz) next_tick_ = now() + before;
  if (rate_hz != 0) rate_hz_ = rate_hz;
  const auto period = tick_period(rate_hz_);
  pause_until(next_tick_ + (is_slow_ ? std::max(before, period) / 2 : kMargin));
  next_tick_ += period;
}

void NodeBench::wait_for_tick() {
  constexpr Duration kAddress = 100us;  // until a node is asked for its first byte
  if (!is_deaf() && !is_slow_) pause_until(next_tick_ - kAddress - kMargin);
}

/// What was said or read between two ticks of a slow loop has to be between them.
void NodeBench::keep_pace() {
  if (!is_slow_ || rate_hz_ == kIdleRateHz || now() < next_tick_ - tick_period(rate_hz_) / 6)
    return;
  leave_open(fmt::format("this machine was too slow to come between ticks of {} Hz", rate_hz_));
}

void NodeBench::expect_read_levels(int levels) {
  expect_read(read_on(4), bytes_of(static_cast<float>(levels) * kVoltsPerLevel));
}

void NodeBench::expect_levels_at_ticks(std::span<const int> levels) {
  int number = 0;
  const auto what = subject();
  for (const auto level : levels) {
    tick();
    about(fmt::format("{}{}tick {}", what, what.empty() ? "" : ", ", ++number));
    expect_levels(level);
  }
  about(what);
}

// ---- States

bool NodeBench::is_alive() {
  if (subject_.is_real) find_node();
  return BusBench::read(subject_.address, 1).has_value() && !error();
}

bool NodeBench::revive() { return reach("power", 1) && is_alive(); }

/// The first one that answers, unless one was found already.
void NodeBench::find_node() {
  for (std::uint8_t node = 0; node <= kLastDocumentedNode && !is_found_ && !error(); ++node) {
    const BusAddress address{node_address(node)};
    is_found_ = BusBench::read(address, 1).has_value();
    if (is_found_) subject_.address = address;
  }
}

void NodeBench::measure_noise() {
  constexpr int kSamples = 20;
  constexpr Duration kAlone = 200us;  // a byte is written, or read, in this time at 100 kHz
  for (int i = 0; i < kSamples && !error(); ++i) {
    const auto asked = now();
    std::ignore = BusBench::read(subject_.address, 1);
    hear_noise(now() - asked - kAlone);
  }
  find_motor();
}

void NodeBench::find_motor() {
  if (subject_.motor != nullptr) return;
  for (const auto& motor : motors()) {
    const bool has_position = read(kReadPositionSet, 31) == bytes_of(motor.position_set);
    const bool has_speed = read(kReadSpeedSet, 31) == bytes_of(motor.speed_set);
    if (has_position || has_speed) subject_.motor = &motor;
  }
}

const Motor& NodeBench::motor() {
  if (subject_.motor != nullptr) return *subject_.motor;
  skip("its controllers are those of no known motor; --allow program loads the stored ones");
  return motors().front();
}

/// 0: held, 1: free.
void NodeBench::hold(std::int64_t shaft) {
  touch("shaft", shaft);
  if (!is_over() && shaft != std::exchange(shaft_, shaft)) has_rested_ = false;
}

void NodeBench::power_up(std::int64_t shaft) {
  hold(shaft);
  touch("adc", 0);
  rate_hz_ = kIdleRateHz;
  next_tick_ = now() + tick_period(kIdleRateHz);
}

void NodeBench::switch_on() {
  prepare(kCalibrationUnknown);
  settle();
  rest();
  touch("power", 1);
  rate_hz_ = kIdleRateHz;
  next_tick_ = now() + tick_period(kIdleRateHz);
  if (subject_.is_real) pause(std::chrono::seconds{1});
}

/// What is not acknowledged here is for the cases to find.
void NodeBench::prepare(const Command& command) {
  if (!is_deaf()) std::ignore = write(subject_.address, encode(command));
}

/// Its mode ends with its next tick.
void NodeBench::leave_slow_loop() {
  if (!is_slow_ || rate_hz_ == kIdleRateHz) return;
  prepare(kCalibrationUnknown);
  pause(2 * tick_period(rate_hz_));
  rate_hz_ = kIdleRateHz;
}

void NodeBench::bring_to(std::size_t start) {
  leave_slow_loop();
  is_slow_ = start == kSlow;
  if (start == kListening) return;
  if (start == kFresh) return power_up(0);
  if (start == kSwitchedOn) return switch_on();
  if (subject_.is_real && shaft_ == 0) hold(1);
  if (start == kFree || start == kSlow) {
    if (!subject_.is_real) power_up(1);
    if (start == kSlow) keep_sets();
    prepare(kCalibrationUnknown);
    prepare(kDefaultControllers);
    settle();
    rest();
    find_motor();
    return prepare(kCalibrateZero);
  }
  if (start == kProgrammable) keep_sets();
  prepare(kCalibrationUnknown);
  // Before any mode is entered: what cases leave behind must never run.
  if (!kept_sets_[0].empty() || start == kProgrammable) prepare(kDefaultControllers);
  settle();
  rest();
  if (start == kProgrammable) find_motor();
  if (start != kUncalibrated) prepare(kCalibrateZero);
}

/// Only a shaft that has rested before, and that gets no slower when nothing drives it, is held
/// against the node: others are pulled by a load, or were turning before we came.
void NodeBench::rest() {
  auto left = watch_rest();
  if (left.is_slower && has_rested_) {
    brake();
    left = watch_rest();
  }
  if (left.is_at_rest) has_rested_ = true;
  if (left.is_at_rest || is_deaf()) return;
  if (!has_rested_ || left.is_slower) {
    return give_up(
        "needs a shaft that rests when nothing drives it; this one turns for more than 5 s: a load "
        "turns it, or the node drives it unasked");
  }
  fail("a shaft that comes to rest within 5 s of its mode being taken away",
       fmt::format("it turned from {} to {} rad, and goes on", left.first, left.last));
}

NodeBench::Coasting NodeBench::watch_rest() {
  constexpr float kClearly = 0.9F;  // reads come at uneven times
  const auto begin = now();
  Coasting seen{.first = number(kReadAngle)};
  seen.last = seen.first;
  std::optional<float> first_way;
  while (!is_deaf()) {
    settle();
    const float angle = number(kReadAngle);
    const float way = std::fabs(angle - seen.last);
    seen.last = angle;
    seen.is_at_rest = way == 0.0F;
    seen.is_slower = way < kClearly * first_way.value_or(way);
    if (!first_way) first_way = way;
    if (seen.is_at_rest || now() - begin >= kRestTime) break;
  }
  return seen;
}

/// With little friction a shaft that nothing drives coasts for long; one that is driven with 0 V
/// does not.
void NodeBench::brake() {
  prepare(kCalibrateZero);
  prepare(kVoltage, 0.0F);
  pause(300ms);
  prepare(kDisable);
  prepare(kCalibrationUnknown);
}

void NodeBench::keep_sets() {
  if (!kept_sets_[0].empty() || is_deaf()) return;
  constexpr std::array kSelectors{kReadPositionSet, kReadSpeedSet};
  for (std::size_t i = 0; i < kSelectors.size(); ++i) {
    const auto bytes = read(kSelectors[i], kLargestSetSize);
    if (const auto set = decode_set(bytes); std::holds_alternative<ControllerSet>(set)) {
      const auto size = encode(std::get<ControllerSet>(set)).view().size();
      kept_sets_[i].assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    }
  }
}

void NodeBench::put_sets_back() {
  if (error()) return;
  begin(profile(), 0);
  leave_slow_loop();
  for (const auto& set : kept_sets_) {
    if (set.empty()) continue;
    std::vector<std::byte> message{static_cast<std::byte>(kProgram)};
    message.insert(message.end(), set.begin(), set.end());
    send(kCalibrationUnknown);
    send_bytes(message);
    settle();
  }
}

}  // namespace armjig::morap::conformance
